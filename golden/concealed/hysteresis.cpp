// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/hysteresis.hpp"

#include <vector>

namespace hemi::concealed {
namespace {

Series to_unit_range(const Series& x) {
  const double low = x.minCoeff(), high = x.maxCoeff();
  return (x - 0.5 * (low + high)) / std::max(0.5 * (high - low), 1e-9);
}

Series to_unit_height(Series y) {
  const double height = y.maxCoeff() - y.minCoeff();
  if (height < 1e-12) return Series::Zero(y.size());
  return (y - y.mean()) / height;
}

struct Relay {
  double up, down, weight;
  bool high;
};

std::vector<Relay> relays(double width, double spread, double start) {
  constexpr int kSide = 40;
  std::vector<Relay> all;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double centre = -1.0 + 2.0 * (i + 0.5) / kSide;
      const double half = (j + 0.5) / kSide;
      const double across = (half - width) / spread, along = centre / 0.8;
      const double weight = std::exp(-0.5 * (across * across + along * along));
      if (weight > 1e-3) all.push_back({centre + half, centre - half, weight, centre < start});
    }
  }
  return all;
}

}  // namespace

Series preisach(const Series& x, double width, double spread) {
  const Series u = to_unit_range(x);
  auto all = relays(width, spread, u[0]);
  double sum = 0.0;
  for (const Relay& relay : all) sum += relay.high ? relay.weight : -relay.weight;
  Series y(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (Relay& relay : all) {
      if (!relay.high && u[i] >= relay.up) {
        relay.high = true;
        sum += 2.0 * relay.weight;
      } else if (relay.high && u[i] <= relay.down) {
        relay.high = false;
        sum -= 2.0 * relay.weight;
      }
    }
    y[i] = sum;
  }
  return to_unit_height(y);
}

Series duhem(const Series& x, double c) {
  const Series u = to_unit_range(x);
  Series y(x.size());
  double state = y[0] = 0.0;
  for (Eigen::Index i = 1; i < x.size(); ++i) {
    const double step = u[i] - u[i - 1];
    const double towards = step < 0.0 ? -1.0 : 1.0;
    state = towards + (state - towards) * std::exp(-c * std::abs(step));  // exact for a monotonic step
    y[i] = state;
  }
  return to_unit_height(y);
}

Series bouc_wen(const Series& x, double c, double b) {
  const Series u = to_unit_range(x);
  const auto slope_of = [&](double z, double step) {
    return c * (step - (b * std::abs(step) * z * std::abs(z) + (1.0 - b) * step * z * z));
  };
  Series y(x.size());
  double z = y[0] = 0.0;
  for (Eigen::Index i = 1; i < x.size(); ++i) {
    const double step = u[i] - u[i - 1];
    const double half = z + 0.5 * slope_of(z, step);
    z += slope_of(half, step);
    y[i] = z;
  }
  return to_unit_height(y);
}

}  // namespace hemi::concealed
