#pragma once
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Plain data as bytes of this machine, bit for bit: what the store keeps between two runs of the same program.
namespace ricochet {

template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Appends values one after the other; texts and vectors behind their length.
class ByteWriter {
 public:
  std::string bytes;

  template <PlainNumber T>
  void operator()(const T& value) {
    raw(&value, sizeof value);
  }
  void operator()(const std::string& text) {
    operator()(static_cast<std::uint64_t>(text.size()));
    bytes.append(text);
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values) {
    operator()(static_cast<std::uint64_t>(values.size()));
    raw(values.data(), values.size() * sizeof(T));
  }

 private:
  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

/// Reads them back in the same order. Throws std::runtime_error where the bytes end too soon.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}

  template <PlainNumber T>
  void operator()(T& value) {
    raw(&value, sizeof value);
  }
  void operator()(std::string& text) {
    text.resize(count(1));
    raw(text.data(), text.size());
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    raw(values.data(), values.size() * sizeof(T));
  }
  /// A number of things that take `unit` bytes each, or more.
  std::size_t count(std::size_t unit) {
    std::uint64_t value = 0;
    raw(&value, sizeof value);
    if (value > (bytes_.size() - at_) / unit) throw std::runtime_error("what was stored is cut short");
    return static_cast<std::size_t>(value);
  }

 private:
  void raw(void* out, std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("what was stored is cut short");
    if (size > 0) std::memcpy(out, bytes_.data() + at_, size);
    at_ += size;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace ricochet
