#include <algorithm>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/instruction_set.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/kernels/quadratic_form.hpp>
#include <stdexcept>

namespace ricochet {

namespace {

// x + Σ_s l_s x_{+s}, s = 1 … W, l_s after l_{s−1}. Products are rounded before they are added, whatever the
// instruction set.
template <int W>
[[gnu::always_inline]] inline void strain_body(int n, const double* l, const double* x, double* out) {
  int i = 0;
  for (; i + 4 + W <= n; i += 4) {
    LooseFour sum = *reinterpret_cast<const LooseFour*>(x + i);
    for (int s = 1; s <= W; ++s)
      sum += *reinterpret_cast<const LooseFour*>(l + (s - 1) * n + i) * *reinterpret_cast<const LooseFour*>(x + i + s);
    *reinterpret_cast<LooseFour*>(out + i) = sum;
  }
  for (; i < n; ++i) {
    double sum = x[i];
    for (int s = 1; s <= W && i + s < n; ++s) sum += l[(s - 1) * n + i] * x[i + s];
    out[i] = sum;
  }
}

// Those of beams and bars.
RICOCHET_AVX2_ALONE void strain_of_one(int n, const double* l, const double* x, double* out) {
  strain_body<1>(n, l, x, out);
}
RICOCHET_AVX2_ALONE void strain_of_three(int n, const double* l, const double* x, double* out) {
  strain_body<3>(n, l, x, out);
}

}  // namespace

struct QuadraticForm::Rows {
  std::vector<int> start{0}, index;
  std::vector<double> value;
  LaneRows view() const { return {static_cast<int>(start.size()) - 1, start.data(), index.data(), value.data()}; }
};

// Row i of a symmetric matrix is its column.
void QuadraticForm::put_rows(const SparseMatrix& matrix) {
  const auto rows = std::make_shared<Rows>();
  const auto most = static_cast<std::size_t>(matrix.nonZeros() + matrix.rows()) / 2;
  rows->index.reserve(most);
  rows->value.reserve(most);
  for (int i = 0; i < matrix.outerSize(); ++i) {
    for (SparseMatrix::InnerIterator it(matrix, i); it; ++it) {
      if (it.row() < i || it.value() == 0) continue;
      rows->index.push_back(static_cast<int>(it.row()));
      rows->value.push_back(it.row() == i ? it.value() / 2 : it.value());
    }
    rows->start.push_back(static_cast<int>(rows->index.size()));
  }
  sparse_ = rows;
  first_.resize(static_cast<std::size_t>(rows_));
}

QuadraticForm QuadraticForm::by_rows() const {
  QuadraticForm rows = *this;
  rows.factor_.reset();
  return rows;
}

QuadraticForm QuadraticForm::by_rows(const SparseMatrix& matrix) {
  const int width = half_bandwidth(matrix);
  if (width <= narrow_band) return QuadraticForm(matrix);
  QuadraticForm rows;
  rows.rows_ = static_cast<int>(matrix.rows());
  rows.width_ = width;
  rows.put_rows(matrix);
  return rows;
}

QuadraticForm::QuadraticForm(const SparseMatrix& matrix)
    : rows_(static_cast<int>(matrix.rows())), width_(half_bandwidth(matrix)) {
  if (width_ > narrow_band) {
    put_rows(matrix);
    factor_ = SparseFactor::of(matrix);
    if (factor_ && !factor_->positive()) factor_.reset();
    if (factor_) work_ = Block(rows_ + 1, 1);
    return;
  }
  diagonals_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(width_ + 1), 0.0);
  QuasiDefinite definite;
  definite.A = matrix;
  BandLdlt ldlt;
  if (rows_ > 0 && width_ > 0 && !ldlt.factorise(definite)) {
    const int w = ldlt.half_width(), stride = 2 * w + 1;
    for (int i = 0; i < rows_; ++i) {
      pivot_.push_back(1 / ldlt.factor()[i * stride + 2 * w]);
      for (int s = 1; s <= w && i + s < rows_; ++s)
        diagonals_[static_cast<std::size_t>(s * rows_ + i)] = ldlt.factor()[i * stride + w + s - 1];
    }
    first_.resize(static_cast<std::size_t>(rows_));
    second_.resize(static_cast<std::size_t>(rows_));
    return;
  }
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      if (it.row() <= j && it.value() != 0)
        diagonals_[static_cast<std::size_t>((j - it.row()) * rows_ + it.row())] = it.value();
}

QuadraticForm::QuadraticForm(const SparseMatrix& coupling, const SparseMatrix& velocity_mass)
    : rows_(static_cast<int>(coupling.cols())), velocity_width_(half_bandwidth(velocity_mass)) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> by_rows = coupling;
  start_.push_back(0);
  for (int i = 0; i < by_rows.rows(); ++i) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(by_rows, i); it; ++it) {
      index_.push_back(static_cast<int>(it.col()));
      value_.push_back(it.value());
    }
    start_.push_back(static_cast<int>(index_.size()));
  }
  QuasiDefinite spd;
  spd.A = velocity_mass;
  BandLdlt ldlt;
  if (const auto wrong = ldlt.factorise(spd)) throw std::logic_error("velocity mass: " + *wrong);
  velocity_width_ = ldlt.half_width();
  const int w = velocity_width_, stride = 2 * w + 1;
  for (int i = 0; i < ldlt.rows(); ++i) {
    for (int s = 0; s < w; ++s) lower_.push_back(ldlt.factor()[i * stride + s]);
    inverse_pivot_.push_back(ldlt.factor()[i * stride + 2 * w]);
  }
  first_.resize(inverse_pivot_.size());
  second_.resize(inverse_pivot_.size());
}

QuadraticForm QuadraticForm::of(const Inertia& inertia) {
  if (inertia.assembled()) return by_rows(inertia.mass);
  const MassFactors factors = mass_factors(inertia);
  return {factors.coupling, factors.velocity_mass};
}

void QuadraticForm::reduce(const double* x, std::vector<double>& out) const {
  const int w = velocity_width_;
  for (int i = 0; i < static_cast<int>(out.size()); ++i) {
    double sum = 0;
    for (int e = start_[static_cast<std::size_t>(i)]; e < start_[static_cast<std::size_t>(i) + 1]; ++e)
      sum += value_[static_cast<std::size_t>(e)] * x[index_[static_cast<std::size_t>(e)]];
    for (int s = std::max(0, w - i); s < w; ++s)
      sum -= lower_[static_cast<std::size_t>(i * w + s)] * out[static_cast<std::size_t>(i - w + s)];
    out[static_cast<std::size_t>(i)] = sum;
  }
}

void QuadraticForm::strain(const double* x, std::vector<double>& out) const {
  if (has_avx2() && (width_ == 1 || width_ == 3))
    return (width_ == 1 ? strain_of_one : strain_of_three)(rows_, diagonals_.data() + rows_, x, out.data());
  std::copy_n(x, rows_, out.data());
  for (int s = 1; s <= width_; ++s) {
    const double* l = diagonals_.data() + static_cast<std::size_t>(s) * static_cast<std::size_t>(rows_);
    for (int i = 0; i + s < rows_; ++i) out[static_cast<std::size_t>(i)] += l[i] * x[i + s];
  }
}

std::optional<QuadraticForm::Squares> QuadraticForm::squares() const {
  if (!start_.empty() || sparse_) return std::nullopt;
  if (width_ == 0) return Squares{0, diagonals_.data(), diagonals_.data()};
  if (pivot_.empty()) return std::nullopt;
  return Squares{width_, diagonals_.data(), pivot_.data()};
}

bool QuadraticForm::unit() const {
  return start_.empty() && !sparse_ && width_ == 0 &&
         std::all_of(diagonals_.begin(), diagonals_.end(), [](double d) { return d == 1; });
}

double QuadraticForm::operator()(const double* x) const {
  return (*this)(x, x);
}

double QuadraticForm::operator()(const double* x, const double* y) const {
  const LaneKernels& kernels = lane_kernels(1);
  if (factor_ && x == y) return factor_->form(x, work_.data());
  if (sparse_) {
    // A = U + Uᵀ.
    const auto with = [&](const double* a, const double* b) {
      kernels.row_product(sparse_->view(), false, b, first_.data());
      return flight_kernels().dot(rows_, a, first_.data());
    };
    const double upper = with(x, y);
    return x == y ? 2 * upper : upper + with(y, x);
  }
  if (!start_.empty()) {
    reduce(x, first_);
    if (x != y) reduce(y, second_);
    const std::vector<double>& other = x == y ? first_ : second_;
    return kernels.triple_product(static_cast<long>(first_.size()), inverse_pivot_.data(), first_.data(), other.data());
  }
  if (!pivot_.empty()) {
    strain(x, first_);
    if (x != y) strain(y, second_);
    return kernels.triple_product(rows_, pivot_.data(), first_.data(), x == y ? first_.data() : second_.data());
  }
  double sum = kernels.triple_product(rows_, diagonals_.data(), x, y);
  for (int s = 1; s <= width_; ++s) {
    const double* a = diagonals_.data() + static_cast<std::size_t>(s) * static_cast<std::size_t>(rows_);
    const double upper = kernels.triple_product(rows_ - s, a, x, y + s);
    sum += x == y ? 2 * upper : upper + kernels.triple_product(rows_ - s, a, y, x + s);
  }
  return sum;
}

InverseForm::InverseForm(const QuasiDefinite& matrix) {
  if (half_bandwidth(matrix.A) <= narrow_band) {
    factorised_ = !ldlt_.factorise(matrix);
    order_ = ldlt_.order();
    return;
  }
  const int dofs = static_cast<int>(matrix.A.rows());
  factor_ = SparseFactor::of(matrix.assemble(order_));
  factorised_ = factor_ != nullptr;
  for (std::size_t j = 0; factorised_ && j < order_.size(); ++j) {
    const bool dof = order_[static_cast<std::size_t>(factor_->order()[j])] < dofs;
    factorised_ = dof == (factor_->pivot()[j] > 0);
  }
}

// The rows of the border are zero.
Eigen::VectorXd InverseForm::in_factor_order(const Eigen::VectorXd& b) const {
  const auto dofs = static_cast<int>(b.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(order_.size()));
  for (std::size_t i = 0; i < order_.size(); ++i)
    if (order_[i] < dofs) right[static_cast<Eigen::Index>(i)] = b[order_[i]];
  return right;
}

Eigen::VectorXd InverseForm::substitute(Eigen::VectorXd right) const {
  if (factor_) {
    Block work(factor_->size() + 1, 1);
    factor_->solve(right.data(), right.data(), work.data());
    return right;
  }
  Block z(ldlt_.rows(), 1, ldlt_.half_width());
  BandStep step;
  ldlt_.substitute_in(step, z.data());
  step.b = right.data();
  lane_kernels(1).band_step(step);
  return Eigen::Map<const Eigen::VectorXd>(z.data(), z.rows());
}

std::optional<double> InverseForm::operator()(const Eigen::VectorXd& b) const {
  if (!factorised_) return std::nullopt;
  const Eigen::VectorXd right = in_factor_order(b), z = substitute(right);
  double form = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) form += right[i] * z[i];
  return form;
}

std::optional<Eigen::VectorXd> InverseForm::solve(const Eigen::VectorXd& b) const {
  if (!factorised_) return std::nullopt;
  const Eigen::VectorXd z = substitute(in_factor_order(b));
  Eigen::VectorXd solution(b.size());
  for (std::size_t i = 0; i < order_.size(); ++i)
    if (order_[i] < b.size()) solution[order_[i]] = z[static_cast<Eigen::Index>(i)];
  return solution;
}

}  // namespace ricochet
