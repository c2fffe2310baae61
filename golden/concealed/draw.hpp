// SPDX-License-Identifier: Apache-2.0
// How the parts of a case are drawn; for cases.cpp and the tests.
#pragma once

#include <optional>

#include "golden/concealed/cases.hpp"

namespace hemi::concealed {

/// Instrument and run of a case, before anything is concealed.
struct Stand {
  Instrument unit{};
  Excitation in{};
  State baseline{};
  Effects present{};  ///< concealed already, and in `baseline`; empty unless an effect needs another to show
  Series case_written_degc{};
  Trace thermometer{};
};

/// To multiples of a step that goes a whole number of times into 1; nearest double, so that few digits print.
Series rounded(const Series& values, double step);

/// A run of `program` with an instrument of its own; its case thermometer is read and rounded.
/// `board_is_resonator`: the board lags as the resonator does, so that without a load of its own the two
/// cannot be told apart.
Stand random_stand(Random& random, const std::string& program, unsigned stimuli,
                   bool board_is_resonator = false, double case_step_degc = 0.0);

/// Fills baseline, case_written_degc and thermometer from unit and in.
void read_thermometer(Random& random, Stand& stand);

Detectability detectability(const Stand& stand);
/// With more noise on the rate.
Detectability detectability_in(const Stand& stand, const NoiseLevel& more);

/// A set of stimuli for recordings that ask for none in particular: none, or some of all.
unsigned random_stimuli(Random& random, double rich_share);

/// Range of d'.
struct Wanted {
  double low = 0.0, high = 0.0;
};

/// An effect with the strength that gives a d' drawn from `wanted` (log-uniform), within its physical range.
struct Drawn {
  Random before;
  HiddenEffect truth{};
  std::shared_ptr<const Effect> effect{};
  Trace trace{};
  bool unmistakable = false;  ///< Form's
  NoiseLevel noise{};         ///< what the effect is to others, where it is noise on the rate
};
/// Nothing where this run cannot give such a d'.
std::optional<Drawn> draw_effect(Random& random, const Stand& stand, const Detectability& limit,
                                 const Kind& kind, Wanted wanted);

/// One to three numbers of the model, each wrong by what is plainly seen; their names.
std::vector<std::string> change_numbers(Random& random, const Stand& stand, const Detectability& limit,
                                        Model& stated);

/// What disturbs a recording and is no effect. Called before the noise is drawn (unit) and after (file).
void confound_stand(Random& random, Case& result, Stand& stand);
void confound_file(Random& random, Case& result);

}  // namespace hemi::concealed
