#include <algorithm>
#include <ricochet/engine/flight/push_tables.hpp>
#include <ricochet/kernels/flight_kernels.hpp>

namespace ricochet {
namespace {

std::size_t state_size(const FlightMotion& motion) {
  return static_cast<std::size_t>(motion.slots()) * static_cast<std::size_t>(motion.modes()) +
         static_cast<std::size_t>(motion.drive().count());
}

}  // namespace

long long PushTables::worth(const FlightMotion& motion) {
  constexpr long long by_size = 2000;
  return by_size * static_cast<long long>(state_size(motion));
}

double PushTables::bytes(const FlightMotion& motion) {
  const auto size = static_cast<double>(state_size(motion));
  return 8 * size * size;
}

PushTables::PushTables(const FlightMotion& motion, const StepReadings& reading)
    : motion_(motion), size_(state_size(motion)), row_(reading.row()) {
  form_.resize(size_ * size_);
  moved_.resize(size_ * size_);
  state_.resize(size_);
  for (std::size_t i = 0; i < size_; ++i)
    for (std::size_t j = 0; j < size_; ++j) form_[i * size_ + j] = row_[i] * row_[j];
  while (made_ < shortest) make_next();
  keep();
}

// G by its lower half: what stands beside the diagonal twice.
void PushTables::keep() {
  rows_.push_back(row_);
  std::vector<double>& half = forms_.emplace_back();
  half.reserve(size_ * (size_ + 1) / 2);
  for (std::size_t i = 0; i < size_; ++i)
    for (std::size_t j = 0; j <= i; ++j) half.push_back((i == j ? 1.0 : 2.0) * form_[i * size_ + j]);
}

// row · A of 2^power steps.
void PushTables::times_motion(int power, const double* row, double* __restrict out) const {
  const int n = motion_.modes(), slots = motion_.slots(), drives = motion_.drive().count(), width = slots + drives;
  const double *const table = motion_.table(power), *const turn = motion_.rotation(power);
  const auto entry = [&](int i, int j) { return table + static_cast<std::ptrdiff_t>(i * width + j) * n; };
  std::copy_n(row, size_, out);
  for (int i = 0; i < slots; ++i) {
    const double* const own = row + static_cast<std::ptrdiff_t>(i) * n;
    for (int j = 0; j < slots; ++j) {
      const double* const change = entry(i, j);
      double* const to = out + static_cast<std::ptrdiff_t>(j) * n;
      for (int m = 0; m < n; ++m) to[m] += own[m] * change[m];
    }
    for (int l = 0; l < drives; ++l)
      out[static_cast<std::ptrdiff_t>(slots) * n + l] += flight_kernels().dot(n, own, entry(i, slots + l));
  }
  const double* const driven = row + static_cast<std::ptrdiff_t>(slots) * n;
  for (int k = 0; k < drives; ++k)
    for (int l = 0; l < drives; ++l)
      out[static_cast<std::ptrdiff_t>(slots) * n + l] += driven[k] * turn[k * drives + l];
}

// (8)
void PushTables::make_next() {
  std::vector<double> moved(size_);
  times_motion(made_, row_.data(), moved.data());
  for (std::size_t i = 0; i < size_; ++i) row_[i] += moved[i];
  for (std::size_t i = 0; i < size_; ++i)
    times_motion(made_, form_.data() + i * size_, moved_.data() + i * size_);  // G A
  for (std::size_t i = 0; i < size_; ++i)
    for (std::size_t j = 0; j < i; ++j) std::swap(moved_[i * size_ + j], moved_[j * size_ + i]);
  for (std::size_t i = 0; i < size_; ++i) {
    times_motion(made_, moved_.data() + i * size_, moved.data());
    for (std::size_t j = 0; j < size_; ++j) form_[i * size_ + j] += moved[j];
  }
  ++made_;
}

void PushTables::add(int power, const double* x, const double* e, double& sum, double& squares) {
  while (made_ < power) {
    make_next();
    keep();
  }
  const auto at = static_cast<std::size_t>(power - shortest);
  const auto drives = static_cast<std::size_t>(motion_.drive().count());
  std::copy_n(x, size_ - drives, state_.data());
  std::copy_n(e, drives, state_.data() + (size_ - drives));
  const FlightKernels& kernels = flight_kernels();
  const int size = static_cast<int>(size_);
  sum += kernels.dot(size, rows_[at].data(), state_.data());
  const double* form = forms_[at].data();
  double total = 0;
  for (int i = 0; i < size; form += ++i)
    total += state_[static_cast<std::size_t>(i)] * kernels.dot(i + 1, form, state_.data());
  squares += total;
}

}  // namespace ricochet
