// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/input_hold.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/sinc.hpp>
#include <cmath>
#include <vector>

namespace hemi::diagnosis {
namespace {

constexpr Eigen::Index kHalfTaps = 16;
constexpr double kKaiserBeta = 8.0;

// Weights of the samples -15 .. +16 for the instant `fraction` of a sample after sample 0.
Eigen::VectorXd weights(double fraction) {
  Eigen::VectorXd result(2 * kHalfTaps);
  const double edge = boost::math::cyl_bessel_i(0, kKaiserBeta);
  for (Eigen::Index k = 0; k < result.size(); ++k) {
    const double distance = static_cast<double>(k - kHalfTaps + 1) - fraction;
    const double x = distance / static_cast<double>(kHalfTaps);
    const double window =
        boost::math::cyl_bessel_i(0, kKaiserBeta * std::sqrt(std::max(0.0, 1.0 - x * x))) / edge;
    result[k] = window * boost::math::sinc_pi(boost::math::constants::pi<double>() * distance);
  }
  return result / result.sum();
}

}  // namespace

std::string_view name(Hold hold) {
  switch (hold) {
    case Hold::zero_order:
      return "zero-order";
    case Hold::linear:
      return "linear";
    case Hold::band_limited:
      return "band-limited";
  }
  return "";
}

Eigen::VectorXd refine(const Eigen::VectorXd& force, int substeps, Hold hold) {
  const Eigen::Index n = force.size(), parts = 2 * substeps;
  std::vector<Eigen::VectorXd> phases;
  if (hold == Hold::band_limited) {
    for (Eigen::Index p = 0; p < parts; ++p)
      phases.push_back(weights(static_cast<double>(p) / static_cast<double>(parts)));
  }
  Eigen::VectorXd fine((n - 1) * parts + 1);
  Eigen::VectorXd around(2 * kHalfTaps);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    if (hold == Hold::band_limited) {
      for (Eigen::Index k = 0; k < around.size(); ++k)
        around[k] = force[std::clamp<Eigen::Index>(i + k - kHalfTaps + 1, 0, n - 1)];
    }
    for (Eigen::Index p = 0; p < parts; ++p) {
      const double fraction = static_cast<double>(p) / static_cast<double>(parts);
      double& value = fine[i * parts + p];
      if (hold == Hold::zero_order) value = force[i];
      if (hold == Hold::linear) value = force[i] + fraction * (force[i + 1] - force[i]);
      if (hold == Hold::band_limited) value = phases[static_cast<std::size_t>(p)].dot(around);
    }
  }
  fine[fine.size() - 1] = force[n - 1];
  return fine;
}

}  // namespace hemi::diagnosis
