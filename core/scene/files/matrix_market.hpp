#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <string>
#include <string_view>

namespace ricochet {

/// A symmetric matrix as a file gives it.
struct FileMatrix {
  SparseMatrix matrix;           ///< both triangles, zeros left out, symmetric to the last bit
  double asymmetry = 0;          ///< largest |a_ij − a_ji| over the largest |a_ij|, averaged away
  int row = 0, column = 0;       ///< where that is, from 1
  double there = 0, across = 0;  ///< a_ij and a_ji
};

/// The largest asymmetry that is round-off of the program that wrote the matrix.
inline constexpr double most_asymmetry = 1e-10;

/// Reads Matrix Market (coordinate or array; real or integer; symmetric or general), square, with `dofs` rows.
///
/// A general matrix is returned as ½(A + Aᵀ); whether its asymmetry is acceptable is the caller's question. `table` and
/// `dofs`: where the number of rows comes from. Throws FileError with file, line, what was found and what was expected
/// for every other text: other headers, sizes, entries outside, twice or not finite, a file that ends early or late.
FileMatrix read_matrix_market(std::string_view content, const std::string& name, int dofs, const std::string& table);

}  // namespace ricochet
