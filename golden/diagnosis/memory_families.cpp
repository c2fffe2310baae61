// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/memory_families.hpp"

#include <cmath>
#include <span>
#include <utility>

#include "golden/diagnosis/memory_columns.hpp"

namespace hemi::diagnosis {
namespace {

using C = MemoryColumns;
using Part = std::vector<std::pair<Eigen::Index, double>>;

// Strong enough to keep the normal equations solvable, too weak to be felt.
constexpr double kPolynomialRidge = 1e-7;
// A coefficient that changes with temperature is a correction to one that does not.
constexpr double kProductRidge = 4.0;

std::vector<double> ridges(double decades_a_step) {
  std::vector<double> list;
  for (double e = decades_a_step < 1.0 ? -7.0 : -6.0; e <= 1e-9; e += decades_a_step)
    list.push_back(std::pow(10.0, e));
  return list;
}

// All columns of one memory, its sizes and strengths: one a form.
std::vector<Part> parts(Memory memory, std::span<const Eigen::Index> sizes,
                        const std::vector<double>& strengths) {
  std::vector<Part> list;
  const Eigen::Index most_times = memory == Memory::lag ? 0 : 1;
  for (const Eigen::Index size : sizes) {
    for (Eigen::Index most = 0; most <= most_times; ++most) {
      for (const double strength : strengths) {
        Part part;
        for (Eigen::Index times = 0; times <= most; ++times) {
          for (Eigen::Index k = 0; k < size; ++k) {
            const Eigen::Index column = memory == Memory::lag          ? C::lag(k)
                                        : memory == Memory::hysteresis ? C::play(k, times)
                                                                       : C::drift(k, times);
            part.emplace_back(column, times == 0 ? strength : kProductRidge * strength);
          }
        }
        list.push_back(part);
      }
    }
  }
  return list;
}

MemoryForm form(MemoryFamily family, std::size_t past, Eigen::Index degree, double polynomial_ridge,
                std::initializer_list<const Part*> more) {
  MemoryForm result{family, {0}, {}, past};
  std::vector<double> penalty = {0.0};
  for (Eigen::Index d = 1; d <= degree; ++d) {
    result.columns.push_back(C::power(d));
    penalty.push_back(polynomial_ridge);
  }
  for (const Part* part : more) {
    for (const auto& [column, strength] : *part) {
      result.columns.push_back(column);
      penalty.push_back(strength);
    }
  }
  result.penalty = Eigen::VectorXd::Map(penalty.data(), static_cast<Eigen::Index>(penalty.size()));
  return result;
}

std::vector<MemoryForm> polynomials() {
  std::vector<MemoryForm> list;
  for (Eigen::Index degree = 1; degree < C::kDegrees; ++degree)
    for (const double ridge : ridges(0.5))
      list.push_back(form(MemoryFamily::polynomial, 0, degree, ridge, {}));
  return list;
}

// A polynomial in the temperature behind one or two poles.
std::vector<MemoryForm> pole_forms(std::size_t past) {
  std::vector<MemoryForm> list;
  for (Eigen::Index pair = 0; pair < C::kPairs; ++pair) {
    for (Eigen::Index degree = 1; degree <= C::kCube; ++degree) {
      for (const double ridge : ridges(1.0)) {
        Part part;
        for (Eigen::Index d = 1; d <= degree; ++d) part.emplace_back(C::two_poles(pair, d), ridge);
        list.push_back(form(MemoryFamily::two_poles, past, 0, 0.0, {&part}));
      }
    }
  }
  return list;
}

constexpr Eigen::Index kMostDegree = 3;  // beside a memory
constexpr Eigen::Index kSizes[] = {3, 4, 5}, kDriftSizes[] = {1, 2, 3};
constexpr Eigen::Index kPairSizes[] = {3, 5}, kPairDriftSizes[] = {1, 2};

std::vector<MemoryForm> single_forms(MemoryFamily family, Memory memory, std::size_t past) {
  std::vector<MemoryForm> list;
  const std::span<const Eigen::Index> sizes = memory == Memory::drift ? kDriftSizes : kSizes;
  for (const Part& part : parts(memory, sizes, ridges(0.5)))
    for (Eigen::Index degree = 1; degree <= kMostDegree; ++degree)
      list.push_back(form(family, past, degree, kPolynomialRidge, {&part}));
  return list;
}

std::vector<MemoryForm> pair_forms(MemoryFamily family, Memory one, Memory other, std::size_t past) {
  std::vector<MemoryForm> list;
  const std::span<const Eigen::Index> drift = kPairDriftSizes, rest = kPairSizes;
  const auto first = parts(one, rest, ridges(1.0));
  const auto second = parts(other, other == Memory::drift ? drift : rest, ridges(1.0));
  for (const Part& a : first)
    for (const Part& b : second)
      for (Eigen::Index degree = 1; degree <= kMostDegree; ++degree)
        list.push_back(form(family, past, degree, kPolynomialRidge, {&a, &b}));
  return list;
}

}  // namespace

std::string_view effect_id(Memory memory) {
  switch (memory) {
    case Memory::lag:
      return "thermal_gradient_bias";
    case Memory::two_poles:
      return "thermal_second_time_constant";
    case Memory::hysteresis:
      return "thermal_hysteresis";
    default:
      return "self_heating";
  }
}

std::string_view equation(Memory memory) {
  switch (memory) {
    case Memory::lag:
      return "rate = p(T) + sum g_k (T - T_k), T_k' = (T - T_k) / tau_k";
    case Memory::two_poles:
      return "rate = p(T_2), T_1' = (T - T_1) / tau_1, T_2' = (T_1 - T_2) / tau_2";
    case Memory::hysteresis:
      return "rate = p(T) + sum (w_k + v_k T) (T - play(T, r_k))";
    default:
      return "rate = p(T) + a drift in time (straight, or exponential as after power-on), gain linear in T";
  }
}

std::string_view name(MemoryFamily family) {
  static constexpr std::string_view names[] = {"polynomial in T", "thermal lag",         "two poles",
                                               "hysteresis",      "drift in time",       "lag and hysteresis",
                                               "lag and drift",   "hysteresis and drift"};
  return names[static_cast<std::size_t>(family)];
}

bool holds(MemoryFamily family, Memory memory) {
  switch (memory) {
    case Memory::lag:
      return family == MemoryFamily::lag || family == MemoryFamily::lag_hysteresis ||
             family == MemoryFamily::lag_drift;
    case Memory::two_poles:
      return family == MemoryFamily::two_poles;
    case Memory::hysteresis:
      return family == MemoryFamily::hysteresis || family == MemoryFamily::lag_hysteresis ||
             family == MemoryFamily::hysteresis_drift;
    default:
      return family == MemoryFamily::drift || family == MemoryFamily::lag_drift ||
             family == MemoryFamily::hysteresis_drift;
  }
}

int effects_in(MemoryFamily family) {
  int count = 0;
  for (const Memory memory : kMemories) count += holds(family, memory) ? 1 : 0;
  return count;
}

std::vector<MemoryForm> memory_forms(MemoryFamily family, std::size_t past) {
  switch (family) {
    case MemoryFamily::polynomial:
      return past == 0 ? polynomials() : std::vector<MemoryForm>{};
    case MemoryFamily::lag:
      return single_forms(family, Memory::lag, past);
    case MemoryFamily::two_poles:
      return pole_forms(past);
    case MemoryFamily::hysteresis:
      return single_forms(family, Memory::hysteresis, past);
    case MemoryFamily::drift:
      return past == 0 ? single_forms(family, Memory::drift, past) : std::vector<MemoryForm>{};
    case MemoryFamily::lag_hysteresis:
      return pair_forms(family, Memory::lag, Memory::hysteresis, past);
    case MemoryFamily::lag_drift:
      return pair_forms(family, Memory::lag, Memory::drift, past);
    default:
      return pair_forms(family, Memory::hysteresis, Memory::drift, past);
  }
}

}  // namespace hemi::diagnosis
