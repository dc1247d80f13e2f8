#pragma once
#include <cstddef>
#include <new>
#include <vector>

namespace ricochet {

/// Storage that starts on 64 bytes, wherever it is copied or moved to.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, std::align_val_t(64)); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

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
  double* data() { return storage_.data() + lead_; }
  const double* data() const { return storage_.data() + lead_; }
  double* row(int i) { return data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_); }
  const double* row(int i) const { return data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_); }
  double& at(int i, int lane) { return row(i)[lane]; }
  double at(int i, int lane) const { return row(i)[lane]; }
  void fill(double value) {
    for (std::size_t k = 0; k < size(); ++k) data()[k] = value;
  }

 private:
  static std::size_t round_up(std::size_t n) { return (n + 7) / 8 * 8; }
  int rows_ = 0, lanes_ = 0;
  std::size_t lead_ = 0;
  std::vector<double, CacheLineAllocator<double>> storage_;
};

}  // namespace ricochet
