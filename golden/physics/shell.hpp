// SPDX-License-Identifier: Apache-2.0
// Natural frequency of a thin hemispherical shell by the energy method, and how it moves with temperature.
#pragma once

namespace hemi::physics {

/// I(n) = integral_0^{pi/2} tan^{2n}(phi/2) / sin^3(phi) dphi, the strain energy's integral. n >= 2.
double strain_integral(int n);

/// J(n) = integral_0^{pi/2} [2 sin^2(phi) + (n + cos(phi))^2] tan^{2n}(phi/2) sin(phi) dphi, the kinetic
/// energy's. n >= 2.
double kinetic_integral(int n);

/// A hemispherical shell with a free rim.
struct Shell {
  double youngs_modulus_pa;
  double poisson_ratio;
  double density_kg_m3;
  double mean_radius_m;
  double thickness_m;
};

/// Frequency [Hz] of the inextensional mode of circumferential order n (Rayleigh, Theory of Sound, vol. 1,
/// ch. Xa):
///   w^2 = E h^2 n^2 (n^2-1)^2 I(n) / (3 (1+mu) rho r^4 J(n)).
/// Throws std::invalid_argument for n < 2 or material and dimensions that are not physical.
double natural_frequency_hz(const Shell& shell, int n = 2);

/// A material at a reference temperature, and parabolas through it.
struct Material {
  double reference_degc;
  double youngs_modulus_pa;
  double shear_modulus_pa;
  double density_kg_m3;
  double expansion_per_degc;   ///< linear
  double stiffest_degc;        ///< vertex of both moduli's parabolas
  double youngs_modulus_gain;  ///< relative, from the reference to the vertex
  double shear_modulus_gain;   ///< relative, from the reference to the vertex
};

/// Fused silica. Moduli, density and expansion (5..35 degC) at 20 degC: data sheet of Corning HPFS 7980.
/// Their course over temperature: S. Spinner, "Temperature dependence of elastic constants of vitreous
/// silica", J. Am. Ceram. Soc. 45 (1962) 394: nearly parabolic with the maximum near 1050..1200 degC, Young's
/// modulus 11 % and shear modulus 9 % over those at room temperature. The frequency goes with the square root
/// of the shear modulus: 82 ppm/degC.
inline constexpr Material kFusedSilica{20.0, 72.7e9, 31.4e9, 2201.0, 0.52e-6, 1125.0, 0.11, 0.09};

/// The shell of `radius_m` and `thickness_m` at the material's reference temperature, at `degc`: moduli from
/// the parabolas, mu = E/(2G) - 1, lengths by (1 + a dT), density by (1 + a dT)^-3.
Shell shell_at(const Material& material, double radius_m, double thickness_m, double degc);

}  // namespace hemi::physics
