#pragma once
#include <algorithm>
#include <cereal/archives/binary.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "runners/store/fingerprint.hpp"

/// \file
/// Values as bytes of this machine, bit for bit: what the store keeps between two runs of the same program. A type says
/// of what it consists in a function serialize(archive, value), where it is stored. To be included where that is only:
/// cereal is long to compile.
namespace ricochet {

/// `mark` says what the bytes are, and in which version: "orbits 3". Behind it stands a hash of what follows.
template <class T>
std::string to_bytes(const T& value, const std::string& mark) {
  std::ostringstream stream;
  cereal::BinaryOutputArchive archive(stream);
  archive(value);
  std::string bytes = mark + content_hash(stream.view());
  bytes += stream.view();
  return bytes;
}

/// The value that to_bytes() was given. Throws std::runtime_error for bytes of another mark, and for those that are not
/// whole. It does so before it reads any length in them: a wrong one asks for no memory.
template <class T>
T from_bytes(const std::string& bytes, const std::string& mark) {
  if (!bytes.starts_with(mark)) throw std::runtime_error("what was stored is of another version than " + mark);
  constexpr std::size_t hash_length = 32;
  const std::size_t begin = std::min(bytes.size(), mark.size() + hash_length);
  const std::string content = bytes.substr(begin);
  if (bytes.substr(mark.size(), begin - mark.size()) != content_hash(content))
    throw std::runtime_error("what was stored as " + mark + " is cut short or damaged");
  std::istringstream stream(content);
  cereal::BinaryInputArchive archive(stream);
  T value;
  archive(value);
  return value;
}

/// The same for another process of this program that is told now: what comes through a pipe comes whole, and needs no
/// hash.
template <class T>
std::string packed(const T& value, const std::string& mark) {
  std::ostringstream stream;
  stream << mark;
  cereal::BinaryOutputArchive archive(stream);
  archive(value);
  return std::move(stream).str();
}

/// The value that packed() was given. Throws std::runtime_error for bytes of another mark or cut short.
template <class T>
T unpacked(const std::string& bytes, const std::string& mark) {
  if (!bytes.starts_with(mark)) throw std::runtime_error("a message is of another version than " + mark);
  std::istringstream stream(bytes);
  stream.seekg(static_cast<std::streamoff>(mark.size()));
  cereal::BinaryInputArchive archive(stream);
  T value;
  archive(value);
  return value;
}

}  // namespace ricochet
