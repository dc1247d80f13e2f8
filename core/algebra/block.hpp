#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ricochet {

/// rows × lanes doubles, lanes contiguous, starting on 64 bytes, with at least `border` zero rows before and after.
/// Allocates once, when constructed.
class Block {
 public:
  Block() = default;
  Block(int rows, int lanes, int border = 0)
      : rows_(rows),
        lanes_(lanes),
        lead_(round_up(static_cast<std::size_t>(border) * static_cast<std::size_t>(lanes))),
        storage_(2 * lead_ + round_up(size()) + 16, 0.0) {}

  int rows() const { return rows_; }
  int lanes() const { return lanes_; }
  std::size_t size() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(lanes_); }
  double* data() { return storage_.data() + shift() + lead_; }
  const double* data() const { return storage_.data() + shift() + lead_; }
  double* row(int i) { return data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_); }
  const double* row(int i) const { return data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_); }
  double& at(int i, int lane) { return row(i)[lane]; }
  double at(int i, int lane) const { return row(i)[lane]; }
  void fill(double value) {
    for (std::size_t k = 0; k < size(); ++k) data()[k] = value;
  }

 private:
  static std::size_t round_up(std::size_t n) { return (n + 7) / 8 * 8; }
  // The storage moves with the block, so the first aligned element is found anew.
  std::size_t shift() const {
    const auto address = reinterpret_cast<std::uintptr_t>(storage_.data());
    return (64 - address % 64) % 64 / sizeof(double);
  }
  int rows_ = 0, lanes_ = 0;
  std::size_t lead_ = 0;
  std::vector<double> storage_;
};

}  // namespace ricochet
