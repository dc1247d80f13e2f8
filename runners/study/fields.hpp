#pragma once
#include <limits>

#include "runners/study/field.hpp"

/// \file
/// Keys of the study format, as kinds of study declare theirs. A key whose value may be a list (an axis of the cross
/// product) says so by `axis`; an absent fallback makes a key required.
namespace ricochet::keys {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline const Range any{};
inline const Range positive{0, infinity, true, false};
inline const Range non_negative{0, infinity, false, false};

/// A number, or a list of numbers as an axis.
Field real(const char* key, const char* unit, const Range& range, std::optional<double> fallback, const char* text);
Field integer(const char* key, const Range& range, std::optional<long long> fallback, const char* text);
Field word(const char* key, std::vector<std::string> words, std::optional<std::string> fallback, const char* text);
/// A field of any other form, not an axis.
Field of_form(Field::Form form, const char* key, std::optional<Json> fallback, const char* text);
/// A number or a formula in `variables`, or a list of these as an axis.
Field formula(const char* key, const char* unit, const char* variables, bool nullable, std::optional<Json> fallback,
              const char* text);
Field object(const char* key, std::optional<Json> fallback, const char* text, ObjectForm keys);
Field methods(const char* key, Role role, const char* text);

/// The field as one value, never a list.
Field single(Field field);
/// The field as one value that may be null: no such limit.
Field optional(Field field);

// The keys that several kinds have.
Field step();                           ///< s, an axis
Field steps_per_period();               ///< an axis
Field march(const char* unless_given);  ///< an axis
Field duration();                       ///< s
Field samples();
Field budget();  ///< s; null: no limit
/// The measures, out of these, that the answer of the study is made of; null: those that its kind asks for.
Field observe(std::vector<std::string> measures);

}  // namespace ricochet::keys
