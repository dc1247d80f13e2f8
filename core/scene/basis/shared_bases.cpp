#include <cstring>
#include <list>
#include <mutex>
#include <ricochet/scene/basis/shared_bases.hpp>

namespace ricochet {
namespace {

constexpr std::size_t most_bytes = 128U << 20U;

template <class Matrix>
std::size_t bytes_of(const Matrix& matrix) {
  const auto entries = static_cast<std::size_t>(matrix.nonZeros()),
             outer = static_cast<std::size_t>(matrix.outerSize());
  return entries * (sizeof(double) + sizeof(int)) + outer * sizeof(int);
}

template <class Value>
bool same_bits(const Value* a, const Value* b, Eigen::Index count) {
  return count == 0 || std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(Value)) == 0;
}

/// The same entries in the same places, to the last bit. Both are compressed.
template <class Matrix>
bool identical(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         same_bits(a.outerIndexPtr(), b.outerIndexPtr(), a.outerSize()) &&
         same_bits(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) &&
         same_bits(a.valuePtr(), b.valuePtr(), a.nonZeros());
}

template <class Matrix>
Matrix compressed(const Matrix& matrix) {
  Matrix out = matrix;
  out.makeCompressed();
  return out;
}

struct SharedBasis {
  SparseMatrix stiffness, mass;
  SparseRows contact;
  bool definite = true;
  BasisSpec spec;
  std::shared_ptr<const ModalBasis> basis;

  std::size_t bytes() const {
    return bytes_of(stiffness) + bytes_of(mass) + bytes_of(contact) + bytes_of(basis->mass) +
           static_cast<std::size_t>(basis->shapes.size() + basis->at_points.size()) * sizeof(double);
  }
};

struct BasisCache {
  std::mutex mutex;
  std::list<SharedBasis> kept;  // used last first
  long long made = 0;
};

BasisCache& cache() {
  static BasisCache one;
  return one;
}

}  // namespace

std::shared_ptr<const ModalBasis> shared_basis(const SparseMatrix& stiffness, const SparseMatrix& mass,
                                               const SparseRows& contact, bool definite, const BasisSpec& spec) {
  BasisCache& all = cache();
  const std::lock_guard lock(all.mutex);
  SharedBasis asked{compressed(stiffness), compressed(mass), compressed(contact), definite, spec, nullptr};
  for (auto one = all.kept.begin(); one != all.kept.end(); ++one)
    if (one->definite == definite && one->spec == spec && identical(one->stiffness, asked.stiffness) &&
        identical(one->mass, asked.mass) && identical(one->contact, asked.contact)) {
      all.kept.splice(all.kept.begin(), all.kept, one);
      return one->basis;
    }
  asked.basis = std::make_shared<const ModalBasis>(modal_basis(stiffness, mass, contact, definite, spec));
  ++all.made;
  all.kept.push_front(std::move(asked));
  std::size_t bytes = 0;
  for (auto one = all.kept.begin(); one != all.kept.end();) {
    bytes += one->bytes();
    one = bytes > most_bytes && one != all.kept.begin() ? all.kept.erase(one) : std::next(one);
  }
  return all.kept.front().basis;
}

BasisCount basis_count() {
  BasisCache& all = cache();
  const std::lock_guard lock(all.mutex);
  return {all.made, all.kept.size()};
}

}  // namespace ricochet
