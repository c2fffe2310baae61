// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/nested_selection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "golden/diagnosis/block_statistics.hpp"
#include "golden/diagnosis/simulation_fit.hpp"

namespace hemi::diagnosis {
namespace {

using Index = Eigen::Index;

// Assumptions about the time before the first row, in parts of the recording: none, and the first rows' slope
// for longer and longer.
constexpr double kPasts[] = {0.0, 1.0 / 64.0, 1.0 / 32.0, 1.0 / 16.0};
constexpr std::uint64_t kSelectionSeed = 1;

/// Products of all columns and the rate (the last one), a matrix a block.
struct Products {
  std::vector<Eigen::MatrixXd> block;
  Eigen::MatrixXd total;
};

Products products(const MemoryColumns& columns, const Eigen::VectorXd& rate,
                  const std::vector<calibration::RowRange>& blocks) {
  Products result;
  Eigen::MatrixXd joined(columns.values.rows(), columns.values.cols() + 1);
  joined << columns.values, rate;
  result.total = Eigen::MatrixXd::Zero(joined.cols(), joined.cols());
  for (const auto& block : blocks) {
    const auto part = joined.middleRows(block.begin, block.count);
    result.block.push_back(part.transpose() * part);
    result.total += result.block.back();
  }
  return result;
}

// Products of one form alone, gathered once.
Products of_form(const Products& all, const MemoryForm& form) {
  std::vector<Index> places = form.columns;
  places.push_back(all.total.cols() - 1);
  Products result;
  result.total = all.total(places, places);
  for (const auto& block : all.block) result.block.push_back(block(places, places));
  return result;
}

Eigen::VectorXd ridge(const Eigen::MatrixXd& gram, const Eigen::VectorXd& penalty, double rows) {
  const Index n = penalty.size();
  Eigen::MatrixXd left = gram.topLeftCorner(n, n);
  left.diagonal() += rows * penalty;
  return left.ldlt().solve(gram.col(n).head(n));
}

double squares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b) {
  const Index n = b.size();
  return gram(n, n) - 2.0 * b.dot(gram.col(n).head(n)) + b.dot(gram.topLeftCorner(n, n) * b);
}

constexpr Index kNone = -1;

/// The selections of every fold and of the whole, fed with one form after another.
class Contest {
 public:
  explicit Contest(const std::vector<calibration::RowRange>& blocks)
      : blocks_(blocks), selections_(blocks.size() + 1), least_(blocks.size() + 1) {
    for (auto& fold : least_) fold.fill(std::numeric_limits<double>::infinity());
  }

  void enter(const MemoryForm& form, const Products& all) {
    const Products own = of_form(all, form);
    const auto count = static_cast<Index>(blocks_.size());
    for (Index out = 0; out <= count; ++out) judge(form, own, out == count ? kNone : out);
  }

  const std::vector<Selection>& finish() {
    for (std::size_t fold = 0; fold < selections_.size(); ++fold)
      selections_[fold].chosen = choose(selections_[fold], least_[fold]);
    return selections_;
  }

 private:
  double rows_but(Index out, Index inner) const {
    double rows = 0.0;
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      if (static_cast<Index>(i) != out && static_cast<Index>(i) != inner)
        rows += static_cast<double>(blocks_[i].count);
    return rows;
  }

  void judge(const MemoryForm& form, const Products& own, Index out) {
    const auto fold = static_cast<std::size_t>(out == kNone ? static_cast<Index>(blocks_.size()) : out);
    double& least = least_[fold][static_cast<std::size_t>(form.family)];
    Eigen::MatrixXd training = own.total;
    if (out != kNone) training -= own.block[static_cast<std::size_t>(out)];
    ChosenForm entry{
        form, {}, Eigen::VectorXd(static_cast<Index>(blocks_.size()) - (out == kNone ? 0 : 1)), {}};
    entry.without_a_block.resize(form.penalty.size(), entry.block_squares.size());
    Index at = 0;
    double sum = 0.0;
    for (Index inner = 0; inner < static_cast<Index>(blocks_.size()); ++inner) {
      if (inner == out) continue;
      const Eigen::MatrixXd& left = own.block[static_cast<std::size_t>(inner)];
      const Eigen::VectorXd b = ridge(training - left, form.penalty, rows_but(out, inner));
      entry.without_a_block.col(at) = b;
      sum += entry.block_squares[at++] = std::max(0.0, squares(left, b));
      if (!(sum < least)) return;
    }
    least = sum;
    entry.coefficients = ridge(training, form.penalty, rows_but(out, kNone));
    selections_[fold].best[static_cast<std::size_t>(form.family)] = std::move(entry);
  }

  static const ChosenForm& of(const Selection& selection, MemoryFamily family) {
    return selection.best[static_cast<std::size_t>(family)];
  }

  static bool gains(const ChosenForm& before, const ChosenForm& after) {
    // One row a block, whose square is the block's sum: the bootstrap then draws whole blocks.
    std::vector<calibration::RowRange> rows;
    for (Index i = 0; i < before.block_squares.size(); ++i) rows.push_back({i, 1});
    return bootstrap_gain(before.block_squares.cwiseSqrt(), after.block_squares.cwiseSqrt(), rows,
                          kSelectionSeed)
               .low > 0.0;
  }

  // `squares`: of the best form of each family over the inner folds; infinite where none was entered.
  static MemoryFamily choose(const Selection& selection, const std::array<double, kFamilies>& squares) {
    const auto sum = [&](MemoryFamily family) { return squares[static_cast<std::size_t>(family)]; };
    MemoryFamily one = MemoryFamily::polynomial;
    for (const MemoryFamily family : kMemoryFamilies)
      if (effects_in(family) == 1 && sum(family) < sum(one)) one = family;
    MemoryFamily chosen = one;
    for (const MemoryFamily family : kMemoryFamilies) {
      const bool beside = effects_in(family) == 2 && std::ranges::any_of(kMemories, [&](Memory memory) {
                            return holds(one, memory) && holds(family, memory);
                          });
      if (beside && sum(family) < sum(chosen) && gains(of(selection, one), of(selection, family)))
        chosen = family;
    }
    return chosen;
  }

  const std::vector<calibration::RowRange>& blocks_;
  std::vector<Selection> selections_;
  std::vector<std::array<double, kFamilies>> least_;
};

}  // namespace

Eigen::VectorXd NestedSelection::predict(const MemoryForm& form, const Eigen::VectorXd& coefficients) const {
  const MemoryColumns& bank = columns[form.past];
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(bank.values.rows());
  for (std::size_t j = 0; j < form.columns.size(); ++j)
    sum += coefficients[static_cast<Index>(j)] * bank.values.col(form.columns[j]);
  return sum;
}

Eigen::VectorXd decoy_residual(const CaseRows& rows, const Eigen::VectorXd& decoy_degc, Index blocks,
                               const std::function<void()>& tick) {
  NestedSelection result;
  result.blocks = equal_blocks(rows.time_s.size(), blocks);
  result.columns = {memory_columns({rows.time_s, decoy_degc, rows.rate_dph}, 0.0)};
  result.columns[0].values.leftCols(MemoryColumns::kDegrees) =
      memory_columns(rows, 0.0).values.leftCols(MemoryColumns::kDegrees);
  const Products all = products(result.columns[0], rows.rate_dph, result.blocks);
  Contest contest(result.blocks);
  for (const MemoryFamily family : {MemoryFamily::polynomial, MemoryFamily::lag, MemoryFamily::hysteresis}) {
    for (const MemoryForm& form : memory_forms(family, 0)) {
      tick();
      contest.enter(form, all);
    }
  }
  const auto& folds = contest.finish();
  Eigen::VectorXd residual(rows.time_s.size());
  for (std::size_t fold = 0; fold < result.blocks.size(); ++fold) {
    const auto& block = result.blocks[fold];
    const ChosenForm& own = folds[fold].best[static_cast<std::size_t>(folds[fold].chosen)];
    residual.segment(block.begin, block.count) =
        (rows.rate_dph - result.predict(own.form, own.coefficients)).segment(block.begin, block.count);
  }
  return residual;
}

NestedSelection nested_selection(const CaseRows& rows, Index blocks, const std::function<void()>& tick) {
  NestedSelection result;
  result.blocks = equal_blocks(rows.time_s.size(), blocks);
  Contest contest(result.blocks);
  const double duration = rows.time_s[rows.time_s.size() - 1] - rows.time_s[0];
  for (std::size_t past = 0; past < std::size(kPasts); ++past) {
    result.past_s.push_back(kPasts[past] * duration);
    result.columns.push_back(memory_columns(rows, result.past_s.back()));
    const Products all = products(result.columns.back(), rows.rate_dph, result.blocks);
    for (const MemoryFamily family : kMemoryFamilies) {
      for (const MemoryForm& form : memory_forms(family, past)) {
        tick();
        contest.enter(form, all);
      }
    }
  }
  result.folds = contest.finish();
  result.whole = result.folds.back();
  result.folds.pop_back();

  const Index n = rows.time_s.size();
  result.chosen_held_out.resize(n);
  for (const MemoryFamily family : kMemoryFamilies) {
    const auto f = static_cast<std::size_t>(family);
    const ChosenForm& whole = result.whole.best[f];
    result.train[f] = rows.rate_dph - result.predict(whole.form, whole.coefficients);
    result.held_out[f].resize(n);
    for (std::size_t fold = 0; fold < result.folds.size(); ++fold) {
      const auto& block = result.blocks[fold];
      const ChosenForm& own = result.folds[fold].best[f];
      result.held_out[f].segment(block.begin, block.count) =
          (rows.rate_dph - result.predict(own.form, own.coefficients)).segment(block.begin, block.count);
      if (result.folds[fold].chosen == family)
        result.chosen_held_out.segment(block.begin, block.count) =
            result.held_out[f].segment(block.begin, block.count);
    }
  }
  return result;
}

}  // namespace hemi::diagnosis
