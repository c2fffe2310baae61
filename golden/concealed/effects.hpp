// SPDX-License-Identifier: Apache-2.0
// The physics that the writer can conceal: every effect of the catalogue that telemetry can show, and physics
// that no catalogue has. Equations are written from the physics, in forms of their own.
#pragma once

#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "golden/concealed/instrument.hpp"
#include "golden/concealed/world.hpp"

namespace hemi::concealed {

inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// One effect with everything drawn but its strength, for one instrument and one run.
struct Form {
  std::string name{};  ///< which of several writings of the same physics
  std::function<std::shared_ptr<const Effect>(double strength)> at{};
  double low = 0.0;           ///< smallest strength that makes sense (a count, a whole sample)
  double high = 0.0;          ///< largest physical strength
  bool unmistakable = false;  ///< the kind's equivalents cannot look like this form
  bool scalable = true;       ///< false: the strength is `high`, whatever d' comes of it
  /// Where the effect has no noise-free trace: d' of a strength.
  std::function<double(double strength)> dprime{};
  NoiseLevel noise{};  ///< of a strength of 1, where the form is noise on the rate
  double sign = 1.0;   ///< given to the strength
  std::function<Values(double strength)> parameters{};  ///< as the catalogue names them
};

/// What a form may depend on.
struct Setting {
  Random& random;
  const Excitation& in;
  const Model& model;
  const State& baseline;           ///< the same run without effects
  const Setting* first = nullptr;  ///< the run whose ranges size the form; none: this one

  const Setting& sizing() const { return first != nullptr ? *first : *this; }
};

struct Kind {
  std::string id{};
  std::string channel{};  ///< telemetry channel where it shows most; empty: depends on the run
  unsigned needs = 0;     ///< Stimulus without which it cannot be told from others
  std::function<Form(const Setting&)> draw{};
  std::vector<std::string> equivalents{};  ///< ids that no telemetry alone tells apart from it
  bool unsuited_alone = false;             ///< for pairs and poor excitation only
};

const std::vector<Kind>& catalogue_kinds();
const std::vector<Kind>& unknown_kinds();
/// Throws std::out_of_range for an id that neither list has.
const Kind& kind(const std::string& id);

std::vector<Kind> thermal_kinds();
std::vector<Kind> frequency_kinds();
std::vector<Kind> command_kinds();
std::vector<Kind> rate_kinds();
std::vector<Kind> signal_kinds();

/// An effect that acts at one stage.
std::shared_ptr<const Effect> acting(Stage stage, std::function<void(State&)> act);

/// Adds strength * shape to an output at a stage.
std::shared_ptr<const Effect> adding(Stage stage, int output, const Series& shape, double strength);

/// A series, and what the run that sizes a form has in its place.
struct Sized {
  Series here{}, first{};
};

/// `values` less the least-squares polynomial in x, then divided by the peak-to-peak value of the rest;
/// polynomial and size of the first run.
Sized beyond_polynomial(const Sized& values, const Sized& x, std::size_t order);

}  // namespace hemi::concealed
