// SPDX-License-Identifier: Apache-2.0
// Captures with one thing wrong, from the plant at the ADC's rate with a core closed around it. The front end
// is written here, in other forms than those that the diagnosis fits.
#ifndef HEMI_TESTS_CLI_STAGE_CONCEALED_HPP
#define HEMI_TESTS_CLI_STAGE_CONCEALED_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "golden/diagnosis/stage.hpp"
#include "golden/physics/instrument.hpp"
#include "tb/engine.hpp"

namespace hemi::tests {

enum class Fault { none, pickoff, feedthrough, saturation, nonlinearity, offset, demodulation, core };
inline constexpr int fault_count = 8;
const char* name(Fault fault);
diagnosis::Stage stage_of(Fault fault);

/// What the diagnosis is given.
struct Shown {
  std::vector<tb::SamplePair> pairs;
  std::vector<tb::Record> records;
  physics::Instrument instrument;  ///< nominal
  tb::RegisterValues registers;    ///< as designed
};

struct Concealed {
  Shown shown;
  Fault fault = Fault::none;
  std::string truth;  ///< strength, in words
};

/// `strength` 0..1 places the fault within its range (docs/stage.md) on a logarithmic scale, everything else
/// is drawn from the seed.
Concealed make_concealed(Fault fault, double strength, std::uint64_t seed, double seconds);

/// Puts what is shown through the diagnosis.
diagnosis::StageDiagnosis diagnose(const Shown& shown);

/// Records that a sound core with these registers computes from the samples shown.
std::vector<tb::Record> make_words(const Shown& shown, const tb::RegisterValues& registers);

}  // namespace hemi::tests

#endif  // HEMI_TESTS_CLI_STAGE_CONCEALED_HPP
