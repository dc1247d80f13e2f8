#include <algorithm>
#include <cstring>
#include <ricochet/contract/fingerprint.hpp>

namespace ricochet {
namespace {

void take(std::uint64_t word, Fingerprint& print) {
  print.first = (print.first ^ word) * 0x9e3779b97f4a7c15U;
  print.second = (print.second + word) * 0xc2b2ae3d27d4eb4fU;
  print.second ^= print.second >> 29U;
}

// Four words at a time in prints of their own, which do not wait for each other.
template <class Number>
void take(const Number* from, Eigen::Index count, Fingerprint& print) {
  constexpr std::size_t together = 4, size = sizeof(std::uint64_t);
  const char* at = reinterpret_cast<const char*>(from);
  auto bytes = static_cast<std::size_t>(count) * sizeof(Number);
  std::uint64_t word = 0;
  Fingerprint part[together];
  for (; bytes >= together * size; bytes -= together * size)
    for (Fingerprint& one : part) {
      std::memcpy(&word, at, size);
      take(word, one);
      at += size;
    }
  for (const Fingerprint& one : part) {
    take(one.first, print);
    take(one.second, print);
  }
  for (; bytes >= size; at += size, bytes -= size) {
    std::memcpy(&word, at, size);
    take(word, print);
  }
  word = 0;
  // A matrix without entries has no array of them.
  if (bytes > 0) std::memcpy(&word, at, bytes);
  take(word, print);
}

}  // namespace

Fingerprint pattern_fingerprint(const Eigen::SparseMatrix<double>& matrix) {
  Fingerprint print;
  take(static_cast<std::uint64_t>(matrix.rows()), print);
  take(static_cast<std::uint64_t>(matrix.cols()), print);
  take(matrix.outerIndexPtr(), matrix.outerSize() + 1, print);
  take(matrix.innerIndexPtr(), matrix.nonZeros(), print);
  return print;
}

Fingerprint fingerprint(const Eigen::SparseMatrix<double>& matrix) {
  Fingerprint print = pattern_fingerprint(matrix);
  take(matrix.valuePtr(), matrix.nonZeros(), print);
  return print;
}

bool same_places(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b) {
  return a.isCompressed() && b.isCompressed() && a.rows() == b.rows() && a.cols() == b.cols() &&
         a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

}  // namespace ricochet
