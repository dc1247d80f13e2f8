#pragma once
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <ricochet/contract/parameters.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// A value of an axis as a person reads it: words bare, numbers in their shortest form, null as "none".
std::string plain(const nlohmann::ordered_json& value);

// The manual of what a study or its results call by a name and no plugin provides.

/// "number", "whole number", "true or false", "word".
const char* type_word(const ParameterSpec& spec);
/// The range of a number, the words of a word.
std::string admissible_values(const ParameterSpec& spec);

/// Prints what is known of a structure, a cross-section, a kind of study (text and keys), a measure or an error (unit
/// and meaning). False where nothing is called so.
bool describe_word(const std::string& name, std::ostream& out);

/// The structures, cross-sections and kinds.
std::vector<std::string> words_of_studies();
/// The measures and the errors.
std::vector<std::string> words_of_results();

}  // namespace ricochet
