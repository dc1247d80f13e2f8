#include <algorithm>
#include <list>
#include <mutex>
#include <numeric>
#include <ricochet/contract/fingerprint.hpp>
#include <ricochet/kernels/sparse_factor.hpp>

namespace ricochet {
namespace {

struct Kept {
  Fingerprint of;
  std::weak_ptr<const SparseFactor> factor;
};

struct Cache {
  std::mutex mutex;
  std::list<Kept> kept;
};

Cache& cache() {
  static Cache one;
  return one;
}

}  // namespace

SparseFactor::SparseFactor(const SparseLdlt& ldlt) : pivot_(ldlt.pivot()), order_(ldlt.order()) {
  std::vector<int> natural(pivot_.size());
  std::iota(natural.begin(), natural.end(), 0);
  through_ = SparseSubstitution(ldlt, natural, ldlt.size(), ldlt.size());
}

std::shared_ptr<const SparseFactor> SparseFactor::of(const Eigen::SparseMatrix<double>& A) {
  if (!A.isCompressed()) {
    Eigen::SparseMatrix<double> compressed = A;
    compressed.makeCompressed();
    return of(compressed);
  }
  const Fingerprint print = fingerprint(A);
  Cache& all = cache();
  const std::lock_guard lock(all.mutex);
  all.kept.remove_if([](const Kept& one) { return one.factor.expired(); });
  for (const Kept& one : all.kept)
    if (one.of == print)
      if (auto factor = one.factor.lock()) return factor;
  SparseLdlt ldlt;
  if (!ldlt.factorise(A)) return nullptr;
  const std::shared_ptr<const SparseFactor> made(new SparseFactor(ldlt));
  all.kept.push_back({print, made});
  return made;
}

bool SparseFactor::positive() const {
  return std::all_of(pivot_.begin(), pivot_.end(), [](double d) { return d > 0; });
}

void SparseFactor::solve(const double* b, double* x, double* work) const {
  SparseStep step = through_.step();
  step.b = b;
  step.work = work;
  step.z = x;
  lane_kernels(1).sparse_step(step);
}

double SparseFactor::form(const double* x, double* work) const {
  const LaneKernels& kernels = lane_kernels(1);
  for (std::size_t j = 0; j < order_.size(); ++j) work[j] = x[order_[j]];
  kernels.sparse_strain(through_.step().L, work);
  return kernels.triple_product(static_cast<long>(order_.size()), pivot_.data(), work, work);
}

}  // namespace ricochet
