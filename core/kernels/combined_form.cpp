#include <algorithm>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/instruction_set.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/kernels/quadratic_form.hpp>

namespace ricochet {
namespace {

#define RICOCHET_FORM_BODY [[gnu::always_inline]] inline

using Four = double __attribute__((vector_size(32), may_alias));
using FourMask = decltype(Four{} < Four{});

RICOCHET_FORM_BODY const Four& four(const double* from) {
  return *reinterpret_cast<const Four*>(from);
}

// a shifted by s numbers into b, which follows it.
template <int s>
RICOCHET_FORM_BODY Four shifted(const Four& a, const Four& b) {
  return __builtin_shufflevector(a, b, s, s + 1, s + 2, s + 3);
}

/// Σ_i d_i (x + Σ_s l_s x_{+s})_i² and Σ_i h_i x_i with x = x_0 + Σ_k r_k x_k, by fours; s = 1 … W ≤ 3, 1 ≤ k < N. W =
/// unit: all d_i are 1 and there are no l.
constexpr int unit = -1;
template <int W, int N>
struct Pass {
  static constexpr int stride = 4 * (W + 2);  // h last
  const double* fours;
  const double* in[N];
  double ratio[N];
  double* out;
  Four forms[2] = {}, projections[2] = {};

  RICOCHET_FORM_BODY Pass(const CombinedForm::Packed& packed, const double* const* x, const double* r, double* to)
      : fours(packed.fours), out(to) {
    for (int k = 0; k < N; ++k) {
      in[k] = x[k];
      ratio[k] = r[k];
    }
  }
  RICOCHET_FORM_BODY Four read(int group) const {
    Four x = four(in[0] + 4 * group);
#pragma GCC unroll 4
    for (int k = 1; k < N; ++k) x += ratio[k] * four(in[k] + 4 * group);
    return x;
  }
  // Sums of even and odd fours apart: none waits for the one before it.
  template <int parity>
  RICOCHET_FORM_BODY void add(int group, const Four& here, const Four& next) {
    const double* row = fours + stride * group;
    Four strain = here;
    if constexpr (W >= 1) strain += four(row) * shifted<1>(here, next);
    if constexpr (W >= 2) strain += four(row + 4) * shifted<2>(here, next);
    if constexpr (W >= 3) strain += four(row + 8) * shifted<3>(here, next);
    Four force = strain;
    if constexpr (W >= 0) force *= four(row + 4 * W);
    forms[parity] += force * strain;
    projections[parity] += four(row + 4 * W + 4) * here;
    if (out) *reinterpret_cast<Four*>(out + 4 * group) = here;
  }
  // Whatever stands beyond the last row.
  RICOCHET_FORM_BODY Four read_last(int group, int rows) const {
    const FourMask at = {0, 1, 2, 3}, end = FourMask{} + (rows - 4 * group);
    const Four x = read(group), zero = {};
    return at < end ? x : zero;
  }
  RICOCHET_FORM_BODY static double total(const Four& a, const Four& b) {
    const Four sum = a + b;
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
  RICOCHET_FORM_BODY CombinedForm::Value run(int rows) {
    const int groups = (rows + 3) / 4, last = groups - 1;
    const Four zero = {};
    Four here = last > 0 ? read(0) : read_last(last, rows);
    int group = 0;
    for (; group + 2 < last; group += 2) {
      const Four middle = read(group + 1), next = read(group + 2);
      add<0>(group, here, middle);
      add<1>(group + 1, middle, next);
      here = next;
    }
    for (; group < groups; ++group) {
      const Four next = group + 1 < last ? read(group + 1) : group < last ? read_last(last, rows) : zero;
      add<0>(group, here, next);
      here = next;
    }
    return {total(forms[0], forms[1]), total(projections[0], projections[1])};
  }
};

#define RICOCHET_FORM_SET(NAME, TARGET)                                                                            \
  template <int W, int N>                                                                                          \
  TARGET CombinedForm::Value NAME(const CombinedForm::Packed& packed, const double* const* x, const double* ratio, \
                                  double* out) {                                                                   \
    return Pass<W, N>(packed, x, ratio, out).run(packed.rows);                                                     \
  }                                                                                                                \
  template <int W>                                                                                                 \
  const CombinedForm::Kernel* NAME##_kernels() {                                                                   \
    static constexpr CombinedForm::Kernel by_count[] = {NAME<W, 1>, NAME<W, 2>, NAME<W, 3>, NAME<W, 4>};           \
    return by_count;                                                                                               \
  }
RICOCHET_FORM_SET(plain, )
RICOCHET_FORM_SET(wide, RICOCHET_AVX2)
RICOCHET_FORM_SET(widest, RICOCHET_AVX512)

template <int W>
const CombinedForm::Kernel* kernels_of() {
  switch (best_instruction_set()) {
    case InstructionSet::avx512:
      return widest_kernels<W>();
    case InstructionSet::avx2:
      return wide_kernels<W>();
    default:
      return plain_kernels<W>();
  }
}

}  // namespace

CombinedForm::CombinedForm(const QuadraticForm& form, const double* h) : rows_(form.rows()) {
  const std::optional<QuadraticForm::Squares> squares = form.squares();
  const int width = form.unit() ? unit : squares ? squares->width : 2;
  kernels_ = width == unit ? kernels_of<unit>()
             : width == 0  ? kernels_of<0>()
             : width == 1  ? kernels_of<1>()
             : width == 3  ? kernels_of<3>()
                           : nullptr;
  if (!kernels_) {
    general_ = form;
    shape_ = Block(rows_, 1);
    if (h) std::copy_n(h, rows_, shape_.data());
    combined_ = Block(rows_, 1);
    return;
  }
  fours_ = packed(form, h, width);
}

Block CombinedForm::packed(const QuadraticForm& form, const double* h, int width) {
  const std::optional<QuadraticForm::Squares> squares = form.squares();
  const int rows = form.rows(), groups = (rows + 3) / 4, stride = 4 * (width + 2);
  if (!squares || squares->width > std::max(width, 0)) return {};
  Block fours(groups * stride, 1);
  for (int i = 0; i < rows; ++i) {
    double* row = fours.data() + static_cast<std::ptrdiff_t>(i / 4) * stride + i % 4;
    for (int s = 1; s <= squares->width; ++s)
      row[4 * (s - 1)] = squares->upper[static_cast<std::ptrdiff_t>(s) * rows + i];
    if (width >= 0) row[4 * width] = squares->pivot[i];
    if (h) row[4 * width + 4] = h[i];
  }
  return fours;
}

// Another width, or factors.
CombinedForm::Value CombinedForm::at_length(int count, const double* const* x, const double* ratio, double* out) const {
  double* to = out ? out : combined_.data();
  lane_kernels(1).combine(rows_, count, x, ratio, to);
  return {general_(to), flight_kernels().dot(rows_, shape_.data(), to)};
}

}  // namespace ricochet
