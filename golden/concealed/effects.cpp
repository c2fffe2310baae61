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

Sized beyond_polynomial(const Sized& values, const Sized& x, std::size_t order) {
  const double centre = x.first.mean(), half = std::max((x.first - centre).abs().maxCoeff(), 1e-9);
  const auto powers = [&](const Series& at) {
    const Series scaled = (at - centre) / half;
    Eigen::MatrixXd all(at.size(), static_cast<Eigen::Index>(order) + 1);
    all.col(0).setOnes();
    for (Eigen::Index k = 1; k < all.cols(); ++k) all.col(k) = all.col(k - 1).array() * scaled;
    return all;
  };
  const Eigen::MatrixXd first = powers(x.first);
  const Eigen::VectorXd fit = first.householderQr().solve(values.first.matrix());
  const Series rest = values.first - (first * fit).array();
  const double height = std::max(rest.maxCoeff() - rest.minCoeff(), 1e-300);
  return {(values.here - (powers(x.here) * fit).array()) / height, rest / height};
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
