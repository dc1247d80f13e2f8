#pragma once
#include <string>
#include <utility>
#include <vector>

#include "runners/json/json_text.hpp"

namespace ricochet {

/// A value of a JSON document and where it stands, for objects whose keys the document itself makes up (slots,
/// parameters). What it throws is an InputError with the pointer of the value.
class JsonPlace {
 public:
  JsonPlace(const Json& value, std::string pointer) : value_(&value), pointer_(std::move(pointer)) {}
  const Json& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }

  /// "expected …, found …".
  [[noreturn]] void unexpected(const std::string& expected) const;
  /// Throws unless the value is an object that has no other keys than these; the nearest one is named.
  void close(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  /// The member of an object; throws "missing; …" where there is none.
  JsonPlace at(const std::string& key, const std::string& meaning = "this key is required") const;
  /// Where a member is or would be.
  std::string pointer_of(const std::string& key) const;
  /// All members in the order of the text; `expected` describes the object.
  std::vector<std::pair<std::string, JsonPlace>> members(const std::string& expected) const;
  /// The elements of a list.
  std::vector<JsonPlace> items(const std::string& expected) const;
  /// A text that is not empty.
  std::string text(const std::string& expected) const;
  /// One of some words.
  std::string word(const std::vector<std::string>& words) const;

 private:
  const Json* value_;
  std::string pointer_;
};

}  // namespace ricochet
