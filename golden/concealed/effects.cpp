// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/effects.hpp"

#include <Eigen/QR>
#include <iterator>
#include <stdexcept>

namespace hemi::concealed {
namespace {

class ActsOnce : public Effect {
 public:
  ActsOnce(Stage stage, std::function<void(State&)> act) : stage_(stage), act_(std::move(act)) {}
  void act(State& state, Stage stage) const override {
    if (stage == stage_) act_(state);
  }

 private:
  Stage stage_;
  std::function<void(State&)> act_;
};

}  // namespace

std::shared_ptr<const Effect> acting(Stage stage, std::function<void(State&)> act) {
  return std::make_shared<ActsOnce>(stage, std::move(act));
}

std::shared_ptr<const Effect> adding(Stage stage, int output, const Series& shape, double strength) {
  return acting(stage, [=](State& s) { s.output(output) += strength * shape; });
}

Series beyond_polynomial(const Series& values, const Series& x, std::size_t order) {
  const double centre = x.mean(), half = std::max((x - centre).abs().maxCoeff(), 1e-9);
  const Series scaled = (x - centre) / half;
  Eigen::MatrixXd powers(x.size(), static_cast<Eigen::Index>(order) + 1);
  powers.col(0).setOnes();
  for (Eigen::Index k = 1; k < powers.cols(); ++k) powers.col(k) = powers.col(k - 1).array() * scaled;
  const Eigen::VectorXd fit = powers.householderQr().solve(values.matrix());
  const Series rest = values - (powers * fit).array();
  return rest / std::max(rest.maxCoeff() - rest.minCoeff(), 1e-300);
}

const std::vector<Kind>& catalogue_kinds() {
  static const std::vector<Kind> kinds = [] {
    std::vector<Kind> all;
    for (auto part : {thermal_kinds(), frequency_kinds(), command_kinds(), rate_kinds(), signal_kinds()})
      std::move(part.begin(), part.end(), std::back_inserter(all));
    return all;
  }();
  return kinds;
}

const Kind& kind(const std::string& id) {
  for (const auto* list : {&catalogue_kinds(), &unknown_kinds()}) {
    for (const Kind& candidate : *list)
      if (candidate.id == id) return candidate;
  }
  throw std::out_of_range("no concealed effect " + id);
}

}  // namespace hemi::concealed
