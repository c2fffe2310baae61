// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "golden/concealed/detectability.hpp"
#include "golden/concealed/effects.hpp"

namespace hemi::concealed {

/// d' at which an effect counts as detectable.
inline constexpr double kLimit = 5.0;

/// In the order in which they are written; with the number of recordings of a full proof.
struct ClassSize {
  std::string name;
  int count;
};
const std::vector<ClassSize>& classes();

/// One effect in the truth.
struct HiddenEffect {
  std::string id{};
  std::string form{};
  std::string channel{};  ///< with the largest share of d'^2
  double strength = 0.0;
  double dprime = 0.0;         ///< alone
  double dprime_beside = 0.0;  ///< what the other effect of a pair cannot take over; alone: dprime
  Values parameters{};         ///< names and units of the catalogue; empty where the form has no such number
};

/// What it takes to give the same effect to the same instrument in another run.
struct Again {
  std::string id{};
  Random before;  ///< the numbers that the form was drawn from
  double strength = 0.0;
};

/// Where the misfit lies, after the refit.
struct HiddenPlace {
  std::string channel{};
  double share = 0.0;                               ///< of d'^2
  std::vector<std::pair<double, double>> time_s{};  ///< stretches that hold 90 % of the slow misfit
};

struct Case {
  std::string cls{};
  std::uint64_t seed = 0, index = 0;
  Instrument unit{};
  Model stated{};  ///< what the model file says
  std::array<bool, kOutputs> colour_stated{};
  Excitation in{};
  std::vector<HiddenEffect> effects{};
  std::vector<Again> again{};
  std::vector<std::string> changed{};  ///< numbers of the model file that are wrong
  std::vector<std::string> confounders{};
  std::vector<std::string> set{};        ///< ids that this recording cannot tell apart, the truth among them
  std::vector<std::string> tolerated{};  ///< names that describe a confounder truly
  double dprime = 0.0;                   ///< of all effects together, after the refit
  std::vector<HiddenPlace> places{};
  std::array<double, kOutputs> noise_rms{};  ///< with the thermometer's share
  std::array<double, kOutputs> trace_rms{};  ///< effects alone, before any refit

  // As written to the file: one value a row, NaN missing.
  Series time_s{}, case_degc{}, board_degc{}, amplitude{};
  State written{};
  std::vector<bool> kept{};  ///< rows that are in the file
  bool board_recorded = true, amplitude_recorded = true;
};

/// Recording `index` of a class. std::invalid_argument for a class that classes() does not list;
/// std::runtime_error where no draw in a hundred can give what the class asks for.
Case make_case(const std::string& cls, std::uint64_t seed, std::uint64_t index);

/// The same instrument and effects in a run with other inputs, one value a second; fresh noise. Forms that
/// are scaled to a run (loop height, total, span) keep the size and shape that they had in the first.
Case repeat_case(const Case& first, const Excitation& inputs);

}  // namespace hemi::concealed
