#pragma once
#include <cstddef>
#include <functional>
#include <type_traits>

/// \file
/// Arrays that a plugin is given while it is checked. What it touches beyond them is named.
namespace ricochet::checking {

/// Bytes that end where memory begins that nobody may touch, and that such memory precedes. The bytes between that and
/// the block are known.
class GuardedBlock {
 public:
  /// `name`: what the contract calls the array; a text that lasts. Throws std::bad_alloc.
  GuardedBlock(const char* name, std::size_t bytes);
  ~GuardedBlock();
  GuardedBlock(const GuardedBlock&) = delete;
  GuardedBlock& operator=(const GuardedBlock&) = delete;

  void* data() const { return begin_; }
  const char* name() const { return name_; }
  /// From now on it may only be read.
  void freeze();
  /// Whether the bytes before the block are as they were made.
  bool intact() const;
  /// What touching this address does to the block; null where it is none of its own.
  const char* trespass(const void* address) const;

 private:
  const char* name_;
  unsigned char *reserved_ = nullptr, *pages_ = nullptr, *begin_ = nullptr;
  std::size_t reserved_bytes_ = 0, page_bytes_ = 0, bytes_ = 0;
};

/// Calls a plugin. Throws std::runtime_error, with the name of the array, where it touches memory beyond a block or
/// writes into one that is frozen. What it held is then lost: a process that checks goes no further with it.
void call_guarded(const std::function<void()>& call);

/// Numbers, or other plain values, in such a block.
template <class Value>
class GuardedArray {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  GuardedArray(const char* name, std::size_t size, Value value = {})
      : block_(name, size * sizeof(Value)), first_(static_cast<Value*>(block_.data())), size_(size) {
    for (Value& one : *this) one = value;
  }
  Value* data() const { return size_ > 0 ? first_ : nullptr; }
  Value* begin() const { return first_; }
  Value* end() const { return first_ + size_; }
  std::size_t size() const { return size_; }
  template <class Index>
  Value& operator[](Index i) const {
    return first_[static_cast<std::size_t>(i)];
  }
  GuardedBlock& block() { return block_; }
  const GuardedBlock& block() const { return block_; }

 private:
  GuardedBlock block_;
  Value* first_;
  std::size_t size_;
};

}  // namespace ricochet::checking
