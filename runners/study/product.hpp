#pragma once
#include <cstddef>
#include <ricochet/contract/errors.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// The most combinations that one study may make.
inline constexpr std::size_t largest_study = 200000;

/// The index tuples of a cross product, the last factor running fastest. No factors: one empty tuple.
class Product {
 public:
  void add(std::size_t size) {
    sizes_.push_back(size);
    index_.push_back(0);
    ended_ = ended_ || size == 0;
  }
  /// Number of tuples, as a real number so that nothing overflows.
  double count() const {
    double count = 1;
    for (const std::size_t size : sizes_) count *= static_cast<double>(size);
    return count;
  }
  /// Throws InputError when there are more than `limit` tuples.
  void refuse_above(std::size_t limit, const std::string& pointer) const;

  bool ended() const { return ended_; }
  std::size_t operator[](std::size_t factor) const { return index_[factor]; }
  void next() {
    for (std::size_t i = sizes_.size(); i-- > 0;) {
      if (++index_[i] < sizes_[i]) return;
      index_[i] = 0;
    }
    ended_ = true;
  }

 private:
  std::vector<std::size_t> sizes_, index_;
  bool ended_ = false;
};

}  // namespace ricochet
