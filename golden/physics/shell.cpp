// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/shell.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hemi::physics {

namespace {

void require_order(int n) {
  if (n < 2)
    throw std::invalid_argument("circumferential order n of an inextensional mode must be at least 2");
}

// Over t = tan(phi/2), 0..1: sin = 2t/(1+t^2), cos = (1-t^2)/(1+t^2), dphi = 2dt/(1+t^2). What is 0/0 at the
// pole in phi is a power of t.
template <class Integrand>
double integrate(const Integrand& integrand) {
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, 0.0, 1.0, 5, 1e-14);
}

}  // namespace

double strain_integral(int n) {
  require_order(n);
  return integrate([n](double t) {
    const double one_plus = 1.0 + t * t;
    return std::pow(t, 2 * n - 3) * one_plus * one_plus / 4.0;
  });
}

double kinetic_integral(int n) {
  require_order(n);
  return integrate([n](double t) {
    const double one_plus = 1.0 + t * t;
    const double sine = 2.0 * t / one_plus;
    const double radial = n + (1.0 - t * t) / one_plus;
    return (2.0 * sine * sine + radial * radial) * std::pow(t, 2 * n) * sine * 2.0 / one_plus;
  });
}

double natural_frequency_hz(const Shell& s, int n) {
  require_order(n);
  if (!(s.youngs_modulus_pa > 0.0 && s.density_kg_m3 > 0.0 && s.thickness_m > 0.0 &&
        s.mean_radius_m > s.thickness_m && s.poisson_ratio > -1.0 && s.poisson_ratio < 0.5)) {
    throw std::invalid_argument(
        "shell: modulus, density and thickness must be positive, radius above thickness, "
        "Poisson's ratio in (-1, 0.5)");
  }
  const double order = static_cast<double>(n) * (static_cast<double>(n) * n - 1.0);
  const double omega_squared =
      s.youngs_modulus_pa * std::pow(s.thickness_m * order, 2) * strain_integral(n) /
      (3.0 * (1.0 + s.poisson_ratio) * s.density_kg_m3 * std::pow(s.mean_radius_m, 4) * kinetic_integral(n));
  return std::sqrt(omega_squared) / (2.0 * std::numbers::pi);
}

Shell shell_at(const Material& m, double radius_m, double thickness_m, double degc) {
  // 0 at the reference, 1 at the vertex
  const double short_of_vertex = (m.stiffest_degc - degc) / (m.stiffest_degc - m.reference_degc);
  const double rise = 1.0 - short_of_vertex * short_of_vertex;
  const double youngs_modulus_pa = m.youngs_modulus_pa * (1.0 + m.youngs_modulus_gain * rise);
  const double shear_modulus_pa = m.shear_modulus_pa * (1.0 + m.shear_modulus_gain * rise);
  const double stretch = 1.0 + m.expansion_per_degc * (degc - m.reference_degc);
  return {youngs_modulus_pa, youngs_modulus_pa / (2.0 * shear_modulus_pa) - 1.0,
          m.density_kg_m3 / (stretch * stretch * stretch), radius_m * stretch, thickness_m * stretch};
}

}  // namespace hemi::physics
