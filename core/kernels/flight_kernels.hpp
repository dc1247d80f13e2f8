#pragma once

/// \file
/// The inner loops of flights, over the modes of one lane. An array is n numbers, one per mode. A table is such arrays,
/// one per entry of a small matrix. Instruction sets are chosen when the table is asked for.
namespace ricochet {

struct FlightKernels {
  static constexpr int in_place = 4;
  /// out_i = x_i + Σ_k t_ik x_k + Σ_k t_i,s+k e_k, elementwise; x: s arrays, e: numbers, t: s × (s + drives) arrays.
  /// `out` may be x itself where s ≤ in_place.
  void (*leap)(int n, int slots, int drives, const double* table, const double* x, const double* e, double* out);
  /// out = Σ_k r_k x_k + Σ_k r_s+k e_k.
  void (*row)(int n, int slots, int drives, const double* row, const double* x, const double* e, double* out);
  /// amplitude += |re + i im|, bend += weight |re + i im|.
  void (*modulus)(int n, const double* re, const double* im, const double* weight, double* amplitude, double* bend);
  /// Where each mode is after 0 and after k steps, and how far from there it may be at any step up to then. It goes
  /// along its first two values c and c + d with second differences of at most `bend`, or stays within its amplitude.
  /// The narrower of both at step k is told. `places`: four arrays, near, its radius, far, its radius.
  void (*cone)(int n, double k, const double* value, const double* change, const double* amplitude, const double* bend,
               double* places);
  /// Σ h_j near_j, Σ |h_j| radius_j, and the same of far, over n modes of arrays that are `stride` numbers apart.
  void (*reach)(int n, long stride, const double* h, const double* places, double* out);
  /// The same of `points` points at once, h by modes: `points` numbers of each. out: four arrays of them.
  void (*reaches)(int n, long stride, int points, const double* h, const double* places, double* out);
  /// Σ_j h_j x_j.
  double (*dot)(int n, const double* h, const double* x);
  /// out_i = Σ_j m_ij x_j, m by rows: bit for bit that of each row alone.
  void (*dots)(int n, int rows, const double* matrix, const double* x, double* out);
  /// The same of several vectors, each bitwise as alone; the matrix, which is what has to come from far, is read once
  /// for two.
  void (*products)(int n, int rows, const double* matrix, int vectors, const double* const* x, double* const* out);
  /// out += a x.
  void (*add)(int n, double a, const double* x, double* out);
  /// Σ_j x_jᵀ Q_j x_j, Q_j symmetric over (x, e), its upper half by rows: w(w+1)/2 arrays.
  double (*quadratic)(int n, int slots, int drives, const double* form, const double* x, const double* e);
};

const FlightKernels& flight_kernels();

}  // namespace ricochet
