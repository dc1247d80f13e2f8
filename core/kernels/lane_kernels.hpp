#pragma once
#include <cstdint>
#include <ricochet/kernels/instruction_set.hpp>

/// \file
/// The inner loops of marching, on blocks of lanes. A block is rows × T doubles with lanes contiguous; T is one of 1,
/// 2, 4, 8, 16, 32. It is 64-byte aligned and padded to a multiple of 64 bytes. Every kernel does the same sequence of
/// operations for each lane, whatever T is. A lane's result does not depend on the other lanes of its block.
/// Instruction sets are chosen when the table is asked for, never by the ABI.
namespace ricochet {

/// The most slots that a kernel takes, and the most terms of a sum over them: the unknown z may stand beside the slots.
/// Up to four slots are written out; beyond, the same operations run in the same order from a loop. A count outside of
/// 1 … limit is a std::logic_error, and nothing is written.
constexpr int most_lane_slots = 8;
constexpr int most_lane_terms = most_lane_slots + 1;

/// One free step with band operators: S z = K k + M m + shape·scale + load, S = L D Lᵀ.
struct BandStep {
  int rows = 0;               ///< n
  int product_width = 0;      ///< half-bandwidth w of K and M
  const double* K = nullptr;  ///< n × (2w+1) by rows, or (2w+1) × n by diagonals when T = 1; null: no product
  const double* k = nullptr;  ///< n × T block, w zero rows before and after
  const double* M = nullptr;  ///< like K; null: no product
  const double* m = nullptr;
  int damping_width = 0;      ///< half-bandwidth of C
  const double* C = nullptr;  ///< like K, of a C that is not made of K and M; null: no product
  const double* c = nullptr;
  const double* shape = nullptr;  ///< n; null: none
  const double* scale = nullptr;  ///< T
  const double* load = nullptr;   ///< n, the same for every lane; null: none
  int solve_rows = 0;             ///< rows of the factor, n or more (quasi-definite form)
  int solve_width = 0;            ///< half-bandwidth v of the factor
  /// Per row: v entries L[i,i−v..i−1], v entries L[i+1..i+v,i] (nearest first), 1/D_i. Null: b is assembled, nothing is
  /// solved.
  const double* factor = nullptr;
  const int* from = nullptr;  ///< row of b for each row of the factor, −1: zero; null: identity
  double* b = nullptr;        ///< scratch block; rows n and beyond are read through `from` and left alone
  double* z = nullptr;        ///< solve_rows × T, v zero rows before and after
};

/// What a free step may do besides, while the rows are at hand: the update x_1 ← x_1 + last, x_0 ← x_0 + x_1 that the
/// stage before left to it, with k = Σ next_j x_j of the slots that come of it.
struct IncrementUpdate {
  double* const* x = nullptr;    ///< two slots
  const double* last = nullptr;  ///< z of the stage before; may be the block that the step writes
  double next[2] = {0, 0};       ///< β^K; not read where the operator is diagonal
};

/// Points that a free step measures and tests, y = value (w_0 x_0 + w_1 x_1 + w_2 z) + offset.
struct PointTest {
  const double* const* x = nullptr;  ///< two slots
  double weight[3] = {0, 0, 0};
  const double* offset = nullptr;  ///< T
  const double* lower = nullptr;   ///< points × T, as upper
  const double* upper = nullptr;
  double* y = nullptr;        ///< points × T
  std::uint32_t outside = 0;  ///< a bit for each lane that is beyond a bound or not a number
};

/// What a free step of one lane adds up besides, of s = z + ratio·x_1 while its rows are at hand:
///
///     form = Σ_i d_i (s_i + Σ_j l_ji s_{i+j})²        projection = Σ_i h_i s_i
///
/// The sums are rounded otherwise than CombinedForm's; z is bitwise what it is without.
struct SquareSum {
  const double* fours = nullptr;  ///< l, d and h as CombinedForm::Packed: j = 1 … 3 by nodes, no l in modes
  const double* x = nullptr;      ///< x_1
  double ratio = 0;
  bool ones = false;  ///< in modes: every d is 1
  double form = 0, projection = 0;
};

/// The step of a BandStep whose rows come by nodes, every node coupled with its neighbours alone. A node has two dofs
/// (deflection and rotation of Hermite elements). With `border` an unknown of the border stands between the two. The
/// operations are those of BandStep in the same order, without the terms that are zero whatever the numbers: the
/// results are the same. Update and measures included, each block is read twice per step, once down the nodes and once
/// up. One lane multiplies and measures in vectors of rows and points.
struct NodeStep {
  int nodes = 0;
  bool border = false;
  /// Per node, as NodeBand packs them: K, shape and L of the rows; 1/D and Lᵀ of them.
  const double* down = nullptr;
  const double* up = nullptr;
  const double* K = nullptr;      ///< T = 1 alone: K by diagonals, 7 × 2 nodes, as in BandStep
  const double* shape = nullptr;  ///< T = 1 alone: load shapes
  const double* k = nullptr;      ///< 2 nodes × T, 3 zero rows before and after; not read where there is an update
  const double* scale = nullptr;  ///< T
  double* z = nullptr;            ///< 2 nodes × T
  double* r = nullptr;            ///< nodes × T, scratch of the border
  const IncrementUpdate* update = nullptr;  ///< null: the slots are what they are
  PointTest* test = nullptr;                ///< null: nothing is measured
  const int* point = nullptr;               ///< per node: the point at its deflection, −1: none
  const double* value = nullptr;            ///< per node: its entry of H
  bool everywhere = false;                  ///< whether the points are those of all nodes
  SquareSum* sum = nullptr;                 ///< T = 1 alone; null: nothing is added up
};

/// Modes i of a step with two slots, and the one point that it measures:
///
///     z_i = c_0i x_0i + c_1i x_1i + c_2i scale
///     y = Σ_i (a_0i x_0i + a_1i x_1i) + direct·scale + offset
///
/// of the slots after an update. y is what PointTest says, with z written out. Terms of y are added by i mod 8, and the
/// eight sums as ((0+4)+(2+6)) + ((1+5)+(3+7)), whatever T is.
struct Modes {
  static constexpr int numbers = 5;
  int rows = 0;
  /// rows × 5: c_0, c_1, c_2, a_0, a_1. By columns where T = 1, each padded with zeros to a multiple of eight.
  const double* coefficient = nullptr;
  double direct = 0;
};

/// The step of a diagonal operator with update and test of one point: z as by diagonal_step of two slots.
struct ModeStep {
  Modes modes;
  const double* const* x = nullptr;
  const double* scale = nullptr;
  double* z = nullptr;
  const IncrementUpdate* update = nullptr;
  PointTest* test = nullptr;
  SquareSum* sum = nullptr;  ///< T = 1 alone; null: nothing is added up
};

/// Steps of modes that nobody looks at: z of the step under way and its update, x_1 ← x_1 + z, x_0 ← x_0 + x_1, then
/// the test of the next. It ends after `steps` of them, or before a step whose point is beyond a bound. Results are
/// bitwise those of ModeStep with its update.
struct ModeRun {
  Modes modes;
  int steps = 0;                   ///< 0: the step under way is tested
  double* x[2] = {};               ///< rows × T, padded with zeros to a multiple of 64 bytes
  const double* scale = nullptr;   ///< (steps + 1) × T: of the step under way, and of those to come
  const double* offset = nullptr;  ///< likewise
  const double* effort = nullptr;  ///< T, in the step under way; null: none
  const double* column = nullptr;  ///< what z gets of it: rows, padded to a multiple of eight
  const double* lower = nullptr;   ///< T, as upper
  const double* upper = nullptr;
  double* y = nullptr;        ///< T, of the step that is under way then
  std::uint32_t outside = 0;  ///< a bit for each lane that is beyond a bound or not a number
};

/// A sparse L D Lᵀ by blocks of neighbouring columns, at most eight, that have the same rows below them. Where rows of
/// one column alone are shared, the others have zeros there.
struct SparseBlocks {
  static constexpr int widest = 8;
  int rows = 0, blocks = 0;
  const int* column = nullptr;      ///< blocks + 1: the first of each
  const int* below = nullptr;       ///< blocks + 1: the first four of rows below each
  const int* index = nullptr;       ///< those rows by fours; `rows` in the place of none
  const double* value = nullptr;    ///< of each block its own rows by rows, a whole number of fours; then, by fours of
                                    ///< rows below, each column
  const double* inverse = nullptr;  ///< 1/D
};

/// S z = b with S = L D Lᵀ sparse, all lanes in one pass over the factor.
struct SparseStep {
  SparseBlocks L;
  const int* from = nullptr;  ///< row of b for each row of the factor, −1: zero
  const int* to = nullptr;    ///< row of z for each row of the factor, −1: none
  const double* b = nullptr;
  double* work = nullptr;  ///< (rows + 1) × T
  double* z = nullptr;
};

/// A row-compressed matrix.
struct LaneRows {
  int rows = 0;
  const int* start = nullptr;  ///< rows + 1
  const int* index = nullptr;
  const double* value = nullptr;
};

struct LaneKernels {
  /// out = Σ_j weight[j] x_j, j < count ≤ most_lane_terms, over `size` doubles.
  void (*combine)(long size, int count, const double* const* x, const double* weight, double* out);
  /// x_j ← Σ_i weight[j·(count+1)+i] x_i + weight[j·(count+1)+count] z, all j at once, then combined = Σ_j next[j] x_j
  /// of the new slots (null: not wanted); count ≤ most_lane_slots, over `size` doubles.
  void (*update)(long size, int count, double* const* x, const double* z, const double* weight, const double* next,
                 double* combined);
  void (*band_step)(const BandStep& step);
  void (*node_step)(const NodeStep& step);
  /// z[i] = Σ_j coefficient[i·(count+1)+j] x_j[i] + coefficient[i·(count+1)+count] scale[lane]: the whole free step of
  /// a diagonal operator; count ≤ most_lane_slots.
  void (*diagonal_step)(int rows, int count, const double* coefficient, const double* const* x, const double* scale,
                        double* z);
  void (*mode_step)(const ModeStep& step);
  /// How many steps were made.
  int (*mode_run)(ModeRun& run);
  void (*sparse_step)(const SparseStep& step);
  /// Lᵀ x in the place of x, rows + 1 numbers of one lane, whatever T.
  void (*sparse_strain)(const SparseBlocks& L, double* x);
  /// y = A x, or y + A x.
  void (*row_product)(const LaneRows& matrix, bool add, const double* x, double* y);
  /// y[i] = Σ_e value[e] (Σ_j weight[j] x_j[index[e]]) + offset[lane], e over row i; count ≤ most_lane_terms; offset
  /// may be null.
  void (*measure)(const LaneRows& matrix, int count, const double* const* x, const double* weight, const double* offset,
                  double* y);
  /// z[i] += column[i] · scale[lane]: a load shape times its amplitudes, a Delassus response times the efforts.
  void (*add_column)(int rows, const double* column, const double* scale, double* z);
  /// Bit l set: lane l has some i with y[i] < lower[i] or y[i] > upper[i], or y[i] not a number.
  std::uint32_t (*outside)(int rows, const double* y, const double* lower, const double* upper);
  /// Σ_i a[i] x[i] y[i] over contiguous vectors: one diagonal of a quadratic form, whatever T.
  double (*triple_product)(long size, const double* a, const double* x, const double* y);
};

/// Kernels for T lanes: of the best instruction set of this processor, or of another one that it has. AVX2 and AVX-512
/// do the same operations on each lane in the same order: their results are bitwise equal.
const LaneKernels& lane_kernels(int lanes, InstructionSet set = best_instruction_set());

/// The smallest T that holds `lanes` (1 … 32).
int lane_width(int lanes);

/// "AVX-512", "AVX2 + FMA" or "baseline": what lane_kernels() chose.
const char* lane_instruction_set();

}  // namespace ricochet
