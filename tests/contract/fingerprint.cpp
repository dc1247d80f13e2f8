// A print of a matrix tells every entry and its place.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contract/fingerprint.hpp>
#include <set>
#include <utility>

using namespace ricochet;

namespace {

Eigen::SparseMatrix<double> filled(int rows, int entries) {
  Eigen::SparseMatrix<double> matrix(rows, rows);
  for (int k = 0; k < entries; ++k) matrix.insert(k % rows, k / rows) = 1 + k;
  matrix.makeCompressed();
  return matrix;
}

}  // namespace

TEST_CASE("a print changes with each entry, whatever their number, and with their order") {
  for (int entries = 1; entries <= 19; ++entries) {
    INFO(entries << " entries");
    const Eigen::SparseMatrix<double> matrix = filled(7, entries);
    std::set<std::pair<std::uint64_t, std::uint64_t>> prints;
    const auto take = [&](const Eigen::SparseMatrix<double>& one) {
      const Fingerprint print = fingerprint(one);
      CHECK(prints.emplace(print.first, print.second).second);
    };
    take(matrix);
    CHECK(fingerprint(matrix) == fingerprint(filled(7, entries)));
    for (int k = 0; k < entries; ++k) {
      Eigen::SparseMatrix<double> other = matrix;
      other.valuePtr()[k] = std::nextafter(other.valuePtr()[k], 0.0);
      take(other);
      CHECK(pattern_fingerprint(other) == pattern_fingerprint(matrix));
      // Four words apart, they go into the same part of the print.
      other = matrix;
      if (k + 4 >= entries) continue;
      std::swap(other.valuePtr()[k], other.valuePtr()[k + 4]);
      take(other);
    }
    take(filled(8, entries));
  }
}

TEST_CASE("matrices with entries in the same places are told from others of the same number") {
  const Eigen::SparseMatrix<double> matrix = filled(5, 8);
  Eigen::SparseMatrix<double> moved(5, 5);
  for (int k = 0; k < 8; ++k) moved.insert((k + 1) % 5, k / 5) = 1;
  moved.makeCompressed();
  CHECK(same_places(matrix, 3 * matrix));
  CHECK(matrix.nonZeros() == moved.nonZeros());
  CHECK_FALSE(same_places(matrix, moved));
  CHECK_FALSE(same_places(matrix, filled(5, 9)));
  CHECK_FALSE(same_places(matrix, filled(6, 8)));
}
