// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/hysteresis.hpp"

#include <vector>

namespace hemi::concealed {
namespace {

/// Twice around from -1 to 1 and back; the second time counts.
template <typename Operator>
double opening(const Operator& memory) {
  constexpr Eigen::Index kWay = 500;
  const Series up = Series::LinSpaced(kWay, -1.0, 1.0), down = up.reverse();
  Series loop(4 * kWay);
  loop << up, down, up, down;
  const Series around = memory(loop);
  return (around.segment(2 * kWay, kWay) - around.tail(kWay).reverse()).abs().maxCoeff();
}

/// The operator over x in units of the first run's half range, in units of its height there.
template <typename Operator>
Memory sized(const Series& x, const Series& first, const Operator& memory) {
  const double low = first.minCoeff(), high = first.maxCoeff();
  const auto scaled = [&](const Series& at) -> Series {
    return (at - 0.5 * (low + high)) / std::max(0.5 * (high - low), 1e-9);
  };
  const Series there = memory(scaled(first));
  const double height = there.maxCoeff() - there.minCoeff();
  if (height < 1e-12) return {Series::Zero(x.size()), 0.0};
  return {(memory(scaled(x)) - there.mean()) / height, opening(memory) / height};
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

Series relayed(const Series& u, double width, double spread) {
  auto all = relays(width, spread, u[0]);
  double sum = 0.0;
  for (const Relay& relay : all) sum += relay.high ? relay.weight : -relay.weight;
  Series y(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
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
  return y;
}

Series duhem_of(const Series& u, double c) {
  Series y(u.size());
  double state = y[0] = 0.0;
  for (Eigen::Index i = 1; i < u.size(); ++i) {
    const double step = u[i] - u[i - 1];
    const double towards = step < 0.0 ? -1.0 : 1.0;
    state = towards + (state - towards) * std::exp(-c * std::abs(step));  // exact for a monotonic step
    y[i] = state;
  }
  return y;
}

Series bouc_wen_of(const Series& u, double c, double b) {
  const auto slope_of = [&](double z, double step) {
    return c * (step - (b * std::abs(step) * z * std::abs(z) + (1.0 - b) * step * z * z));
  };
  Series y(u.size());
  double z = y[0] = 0.0;
  for (Eigen::Index i = 1; i < u.size(); ++i) {
    const double step = u[i] - u[i - 1];
    const double half = z + 0.5 * slope_of(z, step);
    z += slope_of(half, step);
    y[i] = z;
  }
  return y;
}

}  // namespace

Memory preisach(const Series& x, const Series& first, double width, double spread) {
  return sized(x, first, [=](const Series& u) { return relayed(u, width, spread); });
}

Memory duhem(const Series& x, const Series& first, double c) {
  return sized(x, first, [=](const Series& u) { return duhem_of(u, c); });
}

Memory bouc_wen(const Series& x, const Series& first, double c, double b) {
  return sized(x, first, [=](const Series& u) { return bouc_wen_of(u, c, b); });
}

}  // namespace hemi::concealed
