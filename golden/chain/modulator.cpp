// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/modulator.hpp"

namespace hemi::golden {

double ErrorFeedback::operator()(double value) {
  const double sum = arithmetic_.round(value, config::dac_sum.fraction) + error_;
  const double word = arithmetic_.round(sum, config::dac.fraction);
  const double inside = std::clamp(word, lowest_of(config::dac), highest_of(config::dac));
  error_ = inside == word ? sum - word : 0.0;
  return inside;
}

Modulator::Modulator(Precision precision, const Settings& settings)
    : arithmetic_(precision),
      settings_(settings),
      drive_dac_(precision),
      rebalance_dac_(precision),
      quadrature_dac_(precision) {}

void Modulator::tick(const Commands& commands, double increment) {
  const double ahead =
      arithmetic_.round_product(arithmetic_.floor(increment, config::increment_operand.fraction),
                                settings_.delay, config::angle.fraction);
  next_ = {commands.drive, commands.rebalance, modulo(settings_.phase + ahead, 1.0),
           quadrature_dac_(commands.quadrature)};
}

void Modulator::run(const Eigen::Ref<const Eigen::ArrayXd>& phase, Eigen::Ref<Eigen::ArrayXd> carrier,
                    Eigen::Ref<Eigen::ArrayXd> drive, Eigen::Ref<Eigen::ArrayXd> rebalance) {
  for (Eigen::Index i = 0; i < phase.size(); ++i) {
    carrier[i] = nco_sine(arithmetic_, phase[i] + now_.offset);
    drive[i] = drive_dac_(0.0 - now_.drive * carrier[i]);
    rebalance[i] = rebalance_dac_(0.0 - now_.rebalance * carrier[i]);
  }
}

}  // namespace hemi::golden
