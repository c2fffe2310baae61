// SPDX-License-Identifier: Apache-2.0
// Noise with given densities. Densities are one-sided.
#pragma once

#include <array>
#include <bit>
#include <boost/random/normal_distribution.hpp>
#include <cstdint>
#include <vector>

namespace hemi::physics {

/// Generator xoshiro256++ (Blackman and Vigna, ACM Trans. Math. Softw. 47 (2021) 36), seeded by splitmix64
/// (Steele, Lea and Flood, OOPSLA 2014). Period 2^256 - 1.
class RandomBits {
 public:
  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }

  /// Streams of one seed are independent sequences.
  explicit RandomBits(std::uint64_t seed, std::uint64_t stream = 0);

  result_type operator()() {
    const result_type result = std::rotl(s_[0] + s_[3], 23) + s_[0];
    const result_type shifted = s_[1] << 17;
    s_[2] ^= s_[0];
    s_[3] ^= s_[1];
    s_[1] ^= s_[2];
    s_[0] ^= s_[3];
    s_[2] ^= shifted;
    s_[3] = std::rotl(s_[3], 45);
    return result;
  }

 private:
  std::array<std::uint64_t, 4> s_;
};

/// Independent standard normal numbers (ziggurat).
class Gaussian {
 public:
  explicit Gaussian(std::uint64_t seed, std::uint64_t stream = 0) : bits_(seed, stream) {}
  double operator()() { return normal_(bits_); }

 private:
  RandomBits bits_;
  boost::random::normal_distribution<double> normal_;
};

/// Where 1/f noise of the instrument begins.
inline constexpr double kFlickerLowestHz = 1e-5;

/// Flicker noise of density S(f) = h / f between `lowest_hz` and `highest_hz`: first-order poles, two a
/// decade, of equal variance h ln(sqrt 10). S then ripples by 2 / cosh(pi^2 / ln(sqrt 10)) = 0.08 %. The
/// poles go on for one and a half decades beyond either end, where S is 1.1 % low for want of more. It starts
/// in its steady state. (Superposition: van der Ziel, Physica 16 (1950) 359.)
class FlickerNoise {
 public:
  /// h: S(f) f in squared units. 0 < lowest_hz < highest_hz. Throws std::invalid_argument.
  FlickerNoise(double h, double lowest_hz, double highest_hz, std::uint64_t seed, std::uint64_t stream = 0);

  /// The value dt_s later; exact for any dt_s >= 0.
  double advance(double dt_s);

  /// S(f) of the sum of poles, units^2/Hz.
  double density(double frequency_hz) const;

  /// h of an Allan deviation's floor: sigma^2 = 2 ln 2 h.
  static double h_of_floor(double allan_deviation);

 private:
  struct Pole {
    double corner_hz;
    double value;
    double decay;  // over dt_s_
    double input;
  };
  void set_interval(double dt_s);

  double deviation_;
  double dt_s_ = -1.0;
  std::vector<Pole> poles_;
  Gaussian gaussian_;
};

/// Random walk: variance density^2 t, density in units/sqrt(s).
class RandomWalk {
 public:
  RandomWalk(double density_per_rts, std::uint64_t seed, std::uint64_t stream = 0)
      : density_(density_per_rts), gaussian_(seed, stream) {}
  double advance(double dt_s);

 private:
  double density_;
  double value_ = 0.0;
  Gaussian gaussian_;
};

/// Standard deviation of independent samples at `rate_hz` that have one-sided density `density_rthz`
/// [units/sqrt(Hz)] up to rate_hz / 2.
double white_deviation(double density_rthz, double rate_hz);

}  // namespace hemi::physics
