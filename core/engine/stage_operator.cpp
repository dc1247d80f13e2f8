#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/engine/indefinite_step.hpp>
#include <ricochet/engine/stage_operator.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/kernels/sparse_substitution.hpp>
#include <utility>

namespace ricochet {
namespace {

bool any(const std::vector<double>& weights) {
  return std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0; });
}

// Throws IndefiniteMatrix where a pivot has the wrong sign: those of `dofs` are positive, those of the border negative.
void refuse_indefinite(const SparseLdlt& ldlt, const SparseMatrix& whole, const std::vector<int>& order, int dofs) {
  constexpr double round_off = 1e-10;  // of a diagonal that all but cancels
  for (std::size_t i = 0; i < ldlt.pivot().size(); ++i) {
    const int row = ldlt.order()[i];
    const double pivot = order[static_cast<std::size_t>(row)] < dofs ? ldlt.pivot()[i] : -ldlt.pivot()[i];
    if (pivot < -round_off * std::abs(whole.coeff(row, row)))
      throw IndefiniteMatrix{fmt::format("pivot {} of {}", i + 1, ldlt.size())};
  }
}

// How a right-hand side multiplies with K, M and C.
enum class Products { by_bands, by_rows };

// What band and sparse operators share: the right-hand side, and M x of a mass that is not assembled. That goes through
// the border: with g = B m / √s_M the solution of the quasi-definite system is S⁻¹(b + M m).
class Assembly {
 public:
  Assembly(const MarchModel& model, const FoldedStage& stage, int lanes, Products products)
      : kernels_(lane_kernels(lanes)),
        rows_(model.rows()),
        slots_(static_cast<int>(stage.mass_history.size())),
        mass_weights_(stage.mass_history),
        shape_(model.support_shape().data()) {
    const Inertia& inertia = model.inertia();
    const bool by_bands = products == Products::by_bands, by_diagonals = lanes == 1;
    const auto stored = [&](const SparseMatrix& matrix, int width, std::vector<double>& band, LaneRows& rows) {
      if (by_bands)
        band = band_storage(matrix, width, by_diagonals);
      else
        rows = RowMatrix::symmetric(matrix);
    };
    width_ = by_bands ? half_bandwidth(model.stiffness()) : 0;
    const MassFactors factors = inertia.assembled() ? MassFactors{} : mass_factors(inertia);
    border_ = stage.mass != 0 ? static_cast<int>(factors.coupling.rows()) : 0;
    if (inertia.assembled() && by_bands) width_ = std::max(width_, half_bandwidth(inertia.mass));
    keeps_combination_ = any(stage.stiffness_history);
    if (keeps_combination_) stored(model.stiffness(), width_, K_, K_rows_);
    if (any(stage.mass_history)) {
      m_ = Block(rows_, lanes, width_);
      if (inertia.assembled()) {
        stored(inertia.mass, width_, M_, M_rows_);
      } else {
        coupling_ = RowMatrix::from(factors.coupling);
        for (double& value : coupling_.value) value /= std::sqrt(stage.mass);
      }
    }
    if (const SparseMatrix* C = model.problem().damping.matrix.get(); C && any(stage.damping_history)) {
      damping_weights_ = stage.damping_history;
      damping_width_ = by_bands ? half_bandwidth(*C) : 0;
      stored(*C, damping_width_, C_, C_rows_);
      c_ = Block(rows_, lanes, damping_width_);
    }
    b_ = Block(rows_ + border_, lanes);
  }

  int border() const { return border_; }
  bool mass_through_border() const { return coupling_.rows() > 0; }
  bool keeps_combination() const { return keeps_combination_; }
  /// Whether b is K k and loads, without M.
  bool stiffness_alone() const { return keeps_combination_ && m_.rows() == 0 && c_.rows() == 0; }
  const double* shape() const { return shape_; }
  Block& right_hand_side() { return b_; }

  BandStep describe(const FreeStepInput& input) {
    if (m_.rows() > 0) {
      kernels_.combine(static_cast<long>(m_.size()), slots_, input.slots, mass_weights_.data(), m_.data());
      if (mass_through_border()) {
        const double one = 1;
        const double* m = m_.data();
        kernels_.measure(coupling_.view(), 1, &m, &one, nullptr, b_.row(rows_));
      }
    }
    if (c_.rows() > 0)
      kernels_.combine(static_cast<long>(c_.size()), slots_, input.slots, damping_weights_.data(), c_.data());
    BandStep step;
    step.rows = rows_;
    step.product_width = width_;
    step.damping_width = damping_width_;
    step.C = C_.empty() ? nullptr : C_.data();
    step.c = c_.data();
    step.K = K_.empty() ? nullptr : K_.data();
    step.k = input.k;
    step.M = M_.empty() ? nullptr : M_.data();
    step.m = m_.data();
    step.shape = input.scale ? shape_ : nullptr;
    step.scale = input.scale;
    step.load = input.load;
    step.b = b_.data();
    return step;
  }

  /// b by rows.
  const double* assemble(const FreeStepInput& input) {
    kernels_.band_step(describe(input));
    const auto add = [&](const LaneRows& matrix, const double* x) {
      if (matrix.rows > 0) kernels_.row_product(matrix, true, x, b_.data());
    };
    add(K_rows_, input.k);
    add(M_rows_, m_.data());
    add(C_rows_, c_.data());
    return b_.data();
  }

 private:
  const LaneKernels& kernels_;
  int rows_, slots_, width_ = 0, border_ = 0, damping_width_ = 0;
  bool keeps_combination_ = false;
  std::vector<double> mass_weights_, damping_weights_, K_, M_, C_;
  LaneRows K_rows_, M_rows_, C_rows_;  // where there are no bands; of the model
  RowMatrix coupling_;
  const double* shape_;
  Block m_, c_, b_;
};

/// Band L D Lᵀ, in place of any dense or general sparse structure. The half-bandwidth is 3 for Hermite, 5 with the
/// interleaved border. It goes by nodes where the matrices come so, with bitwise equal results.
class BandOperator final : public StageOperator {
 public:
  BandOperator(const MarchModel& model, const FoldedStage& stage, int lanes)
      : assembly_(model, stage, lanes, Products::by_bands),
        kernels_(lane_kernels(lanes)),
        stiffness_(model.stiffness()),
        slots_(static_cast<int>(stage.mass_history.size())),
        lanes_(lanes),
        rows_(model.rows()) {}

  std::optional<std::string> factorise(const QuasiDefinite& matrix) {
    if (auto wrong = ldlt_.factorise(matrix)) {
      std::vector<int> order;
      const SparseMatrix whole = matrix.assemble(order);
      if (SparseLdlt ldlt; ldlt.factorise(whole)) refuse_indefinite(ldlt, whole, order, rows_);
      return wrong;
    }
    if (assembly_.stiffness_alone()) nodes_ = NodeBand(stiffness_, assembly_.shape(), ldlt_);
    if (nodes_.border()) border_ = Block(nodes_.nodes(), lanes_);
    zero_scale_ = Block(1, lanes_);
    from_ = column_from_ = ldlt_.order();
    // The border's part of the right-hand side is zero, unless M x goes through it.
    for (int& row : column_from_)
      if (row >= rows_) row = -1;
    if (!assembly_.mass_through_border()) from_ = column_from_;
    place_.assign(static_cast<std::size_t>(rows_), 0);
    for (int r = 0; r < ldlt_.rows(); ++r)
      if (const int unknown = ldlt_.order()[static_cast<std::size_t>(r)]; unknown < rows_)
        place_[static_cast<std::size_t>(unknown)] = r;
    solution_ = Block(ldlt_.rows(), lanes_, ldlt_.half_width());
    column_ = Block(ldlt_.rows(), 1, ldlt_.half_width());
    if (!ldlt_.natural()) unknown_ = Block(rows_, lanes_);
    return std::nullopt;
  }

  bool keeps_combination() const override { return assembly_.keeps_combination(); }
  // One lane's is faster apart, by vectors of rows.
  bool takes_update() const override { return !nodes_.empty() && slots_ == 2 && lanes_ > 1; }
  bool takes_points(const LaneRows& rows, const double* /*weight*/) override {
    return !nodes_.empty() && slots_ == 2 && nodes_.place_points(rows);
  }
  std::optional<int> sums_squares() const override {
    return !nodes_.empty() && slots_ == 2 && lanes_ == 1 ? std::optional(3) : std::nullopt;
  }

  void free_step(const FreeStepInput& input) override {
    if (!nodes_.empty() && !input.load) return step_by_nodes(input);
    BandStep step = assembly_.describe(input);
    step.from = ldlt_.natural() ? nullptr : from_.data();
    ldlt_.substitute_in(step, solution_.data());
    kernels_.band_step(step);
    if (ldlt_.natural()) return;
    const auto lanes = static_cast<std::size_t>(lanes_);
    for (int i = 0; i < rows_; ++i)
      std::copy_n(solution_.row(place_[static_cast<std::size_t>(i)]), lanes, unknown_.row(i));
  }

  double* unknown() override { return ldlt_.natural() ? solution_.data() : unknown_.data(); }

  void solve_column(const double* rhs, double* x) override {
    BandStep step;
    ldlt_.substitute_in(step, column_.data());
    step.from = column_from_.data();
    // The right-hand side is given: no product, no shape; b is read only.
    step.rows = 0;
    step.b = const_cast<double*>(rhs);
    lane_kernels(1).band_step(step);
    for (int i = 0; i < rows_; ++i) x[i] = column_.data()[place_[static_cast<std::size_t>(i)]];
  }

 private:
  void step_by_nodes(const FreeStepInput& input) {
    NodeStep step = nodes_.step();
    step.k = input.k;
    step.scale = input.scale ? input.scale : zero_scale_.data();
    step.z = unknown();
    step.r = border_.data();
    step.update = input.update;
    step.test = input.test;
    step.sum = input.sum;
    kernels_.node_step(step);
  }

  Assembly assembly_;
  const LaneKernels& kernels_;
  const SparseMatrix& stiffness_;
  int slots_, lanes_, rows_;
  BandLdlt ldlt_;
  NodeBand nodes_;
  std::vector<int> from_, place_, column_from_;
  Block solution_, unknown_, column_, border_, zero_scale_;
};

/// S = s_M M with M⁻¹ known: z = (M⁻¹ (Σ β^K_j K x_j + …) + Σ β^M_j x_j) / s_M, products in place of a solve.
class InverseOperator final : public StageOperator {
 public:
  InverseOperator(const MarchModel& model, const FoldedStage& stage, int lanes)
      : kernels_(lane_kernels(lanes)),
        rows_(model.rows()),
        slots_(static_cast<int>(stage.mass_history.size())),
        stiffness_width_(half_bandwidth(model.stiffness())),
        inverse_width_(half_bandwidth(model.inertia().inverse)),
        shape_(model.support_shape().data()) {
    const SparseMatrix inverse = model.inertia().inverse / stage.mass;
    const bool by_diagonals = lanes == 1;
    inverse_ = band_storage(inverse, inverse_width_, by_diagonals);
    columns_ = RowMatrix::from(inverse);
    if (any(stage.stiffness_history)) K_ = band_storage(model.stiffness(), stiffness_width_, by_diagonals);
    if (stage.uses_mass()) {
      for (const double weight : stage.mass_history) mass_weights_.push_back(weight / stage.mass);
      history_ = Block(rows_, lanes);
    }
    force_ = Block(rows_, lanes, inverse_width_);
    unknown_ = Block(rows_, lanes);
  }

  bool keeps_combination() const override { return !K_.empty(); }

  void free_step(const FreeStepInput& input) override {
    BandStep force;
    force.rows = rows_;
    force.product_width = stiffness_width_;
    force.K = K_.empty() ? nullptr : K_.data();
    force.k = input.k;
    force.shape = input.scale ? shape_ : nullptr;
    force.scale = input.scale;
    force.load = input.load;
    force.b = force_.data();
    kernels_.band_step(force);
    BandStep product;
    product.rows = rows_;
    product.product_width = inverse_width_;
    product.K = inverse_.data();
    product.k = force_.data();
    product.b = unknown_.data();
    kernels_.band_step(product);
    if (mass_weights_.empty()) return;
    const auto size = static_cast<long>(unknown_.size());
    kernels_.combine(size, slots_, input.slots, mass_weights_.data(), history_.data());
    const double* parts[2] = {unknown_.data(), history_.data()};
    const double both[2] = {1, 1};
    kernels_.combine(size, 2, parts, both, unknown_.data());
  }

  double* unknown() override { return unknown_.data(); }

  void solve_column(const double* rhs, double* x) override {
    for (int i = 0; i < rows_; ++i) x[i] = columns_.times(i, rhs);
  }

 private:
  const LaneKernels& kernels_;
  int rows_, slots_, stiffness_width_, inverse_width_;
  const double* shape_;
  std::vector<double> K_, inverse_, mass_weights_;
  RowMatrix columns_;
  Block force_, history_, unknown_;
};

/// A sparse L D Lᵀ by blocks of columns, which all lanes are substituted through at once; products by rows.
class SparseOperator final : public StageOperator {
 public:
  SparseOperator(const MarchModel& model, const FoldedStage& stage, int lanes)
      : assembly_(model, stage, lanes, Products::by_rows),
        kernels_(lane_kernels(lanes)),
        lanes_(lanes),
        rows_(model.rows()) {}

  std::optional<std::string> factorise(const QuasiDefinite& matrix) {
    std::vector<int> order;
    SparseLdlt ldlt;
    const SparseMatrix whole = matrix.assemble(order);
    if (!ldlt.factorise(whole)) return "the matrix of the step is singular (CHOLMOD: " + ldlt.reason() + ")";
    refuse_indefinite(ldlt, whole, order, rows_);
    // The border's part of the right-hand side is zero, unless M x goes through it.
    const int known = assembly_.mass_through_border() ? assembly_.right_hand_side().rows() : rows_;
    through_ = SparseSubstitution(ldlt, order, known, rows_);
    work_ = Block(through_.rows() + 1, lanes_);
    column_work_ = Block(through_.rows() + 1, 1);
    unknown_ = Block(rows_, lanes_);
    return std::nullopt;
  }

  bool keeps_combination() const override { return assembly_.keeps_combination(); }

  void free_step(const FreeStepInput& input) override {
    SparseStep step = through_.step();
    step.b = assembly_.assemble(input);
    step.work = work_.data();
    step.z = unknown_.data();
    kernels_.sparse_step(step);
  }

  double* unknown() override { return unknown_.data(); }

  void solve_column(const double* rhs, double* x) override {
    SparseStep step = through_.step_of_wanted();
    step.b = rhs;
    step.work = column_work_.data();
    step.z = x;
    lane_kernels(1).sparse_step(step);
  }

 private:
  Assembly assembly_;
  const LaneKernels& kernels_;
  int lanes_, rows_;
  SparseSubstitution through_;
  Block work_, column_work_, unknown_;
};

/// A stage that is solved once, without a factor of its own: conjugate gradients with S₀⁻¹ of another stage (Hestenes,
/// Stiefel 1952). The spectrum of S₀⁻¹S lies in [a, a + b / s₀_M], hence a few products do. Each lane goes alone.
class NearOperator final : public StageOperator {
 public:
  NearOperator(const MarchModel& model, const FoldedStage& stage, int lanes, StageOperator& other)
      : assembly_(model, stage, lanes, Products::by_rows), model_(model), stage_(stage), other_(other) {
    const auto n = static_cast<std::size_t>(model.rows());
    for (std::vector<double>* vector : {&solution_, &direction_, &product_, &residual_, &response_}) vector->resize(n);
    unknown_ = Block(model.rows(), lanes);
  }

  bool keeps_combination() const override { return assembly_.keeps_combination(); }
  double* unknown() override { return unknown_.data(); }

  void free_step(const FreeStepInput& input) override {
    const double* b = assembly_.assemble(input);
    const int lanes = unknown_.lanes();
    for (int lane = 0; lane < lanes; ++lane) {
      for (std::size_t i = 0; i < residual_.size(); ++i) residual_[i] = b[i * static_cast<std::size_t>(lanes) + lane];
      solve();
      for (std::size_t i = 0; i < residual_.size(); ++i) unknown_.at(static_cast<int>(i), lane) = solution_[i];
    }
  }

  // Columns of points that something pushes: a factor costs less than many.
  void solve_column(const double* rhs, double* x) override {
    if (!factor_)
      factor_ =
          std::move(std::get<std::unique_ptr<StageOperator>>(make_operator(OperatorKind::sparse, model_, stage_, 1)));
    factor_->solve_column(rhs, x);
  }

 private:
  // S x = r from x = 0; r becomes what is left of it.
  void solve() {
    constexpr double round_off = 1e-17;  // of the first residual, in the norm of S₀⁻¹
    constexpr int most = 200;
    const auto n = static_cast<Eigen::Index>(residual_.size());
    const auto at = [n](std::vector<double>& vector) { return Eigen::Map<Eigen::VectorXd>(vector.data(), n); };
    auto x = at(solution_), d = at(direction_), Sd = at(product_), r = at(residual_), y = at(response_);
    x.setZero();
    other_.solve_column(r.data(), y.data());
    d = y;
    double size = r.dot(y);
    const double first = size;
    for (int k = 0; k < most && size > round_off * round_off * first; ++k) {
      Sd.noalias() = stage_.mass * (model_.inertia().mass * d);
      Sd.noalias() += stage_.stiffness * (model_.stiffness() * d);
      const double length = size / d.dot(Sd);
      x += length * d;
      r -= length * Sd;
      other_.solve_column(r.data(), y.data());
      const double before = std::exchange(size, r.dot(y));
      d = y + size / before * d;
    }
  }

  Assembly assembly_;
  const MarchModel& model_;
  FoldedStage stage_;
  StageOperator& other_;
  std::unique_ptr<StageOperator> factor_;
  std::vector<double> solution_, direction_, product_, residual_, response_;
  Block unknown_;
};

template <class Operator>
OperatorOrRefusal factorised(std::unique_ptr<Operator> made, const QuasiDefinite& matrix) {
  if (const auto wrong = made->factorise(matrix)) return Refusal{*wrong};
  return std::unique_ptr<StageOperator>(std::move(made));
}

}  // namespace

const char* operator_name(OperatorKind kind) {
  switch (kind) {
    case OperatorKind::automatic:
      return "automatic";
    case OperatorKind::diagonal:
      return "diagonal";
    case OperatorKind::modal:
      return "modal";
    case OperatorKind::band:
      return "band";
    case OperatorKind::sparse:
      break;
  }
  return "sparse";
}

bool FoldedStage::uses_mass() const {
  return any(mass_history);
}

bool FoldedStage::driven() const {
  return any(mass_history) || any(stiffness_history) || any(damping_history);
}

FoldedStage fold(const OperatorWeights& weights, const Damping& damping) {
  FoldedStage folded;
  folded.mass = weights.M + damping.mass * weights.C;
  folded.stiffness = weights.K + damping.stiffness * weights.C;
  if (damping.own()) folded.damping = weights.C;
  return folded;
}

FoldedStage fold(const Stage& stage, const Damping& damping, int slots) {
  FoldedStage folded = fold(stage.matrix, damping);
  folded.mass_history.assign(static_cast<std::size_t>(slots), 0.0);
  folded.stiffness_history.assign(static_cast<std::size_t>(slots), 0.0);
  folded.damping_history.assign(static_cast<std::size_t>(slots), 0.0);
  for (std::size_t j = 0; j < stage.history.size(); ++j) {
    folded.mass_history[j] = stage.history[j].M + damping.mass * stage.history[j].C;
    folded.stiffness_history[j] = stage.history[j].K + damping.stiffness * stage.history[j].C;
    if (damping.own()) folded.damping_history[j] = stage.history[j].C;
  }
  return folded;
}

QuasiDefinite stage_system(const MarchModel& model, const FoldedStage& stage) {
  const std::shared_ptr<const SparseMatrix>& C = model.problem().damping.matrix;
  if (!C || stage.damping == 0) return weighted_system(stage.stiffness, model.stiffness(), stage.mass, model.inertia());
  return weighted_system(1, stage.stiffness * model.stiffness() + stage.damping * *C, stage.mass, model.inertia());
}

std::unique_ptr<StageOperator> make_near_operator(const MarchModel& model, const FoldedStage& stage, int lanes,
                                                  const FoldedStage& other, StageOperator& of_other) {
  // Then conjugate gradients win two digits in three products.
  constexpr double near = 3;
  if (!model.inertia().assembled() || stage.damping != 0 || other.damping != 0) return nullptr;
  if (!(stage.stiffness > 0 && other.stiffness > 0 && other.mass > 0)) return nullptr;
  const double a = stage.stiffness / other.stiffness, b = stage.mass - a * other.mass;
  if (b < 0 || a + b / other.mass > near * a) return nullptr;
  return std::make_unique<NearOperator>(model, stage, lanes, of_other);
}

OperatorOrRefusal make_operator(OperatorKind kind, const MarchModel& model, const FoldedStage& stage, int lanes) {
  if (kind == OperatorKind::modal) return make_modal_operator(model, stage, lanes);
  const Inertia& inertia = model.inertia();
  if (inertia.inverted() && stage.stiffness == 0 && !model.problem().damping.matrix) {
    if (stage.mass < 0) throw IndefiniteMatrix{"every motion"};
    return std::make_unique<InverseOperator>(model, stage, lanes);
  }
  if (!inertia.assembled() && stage.mass < 0)
    return Refusal{"the step weights a mass negatively that is not assembled: use the mass consistent or lumped"};
  if (!inertia.assembled() && stage.mass == 0 && stage.uses_mass())
    return Refusal{
        "a stage without inertia multiplies by a mass that is not assembled: use the mass consistent or lumped"};
  const QuasiDefinite matrix = stage_system(model, stage);
  if (kind == OperatorKind::sparse) return factorised(std::make_unique<SparseOperator>(model, stage, lanes), matrix);
  return factorised(std::make_unique<BandOperator>(model, stage, lanes), matrix);
}

}  // namespace ricochet
