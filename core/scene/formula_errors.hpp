#pragma once
#include <string>
#include <vector>

namespace mu {
class Parser;
class ParserError;
}  // namespace mu

namespace ricochet {

/// Throws InputError (with the pointer) for a text that is no expression: empty, or an assignment. muParser reads
/// "x = 3" as one, which would change the variable behind our back.
void require_expression(const std::string& text, const std::string& pointer);

/// Throws InputError (with the pointer) that says what a parser did not understand: an unknown name with the nearest of
/// `names`, the constants and the functions, what `names_in_words` tells of those that may appear; or its own message.
[[noreturn]] void explain_formula(const mu::Parser& parser, const mu::ParserError& error, const std::string& text,
                                  const std::string& pointer, std::vector<std::string> names,
                                  const std::string& names_in_words);

}  // namespace ricochet
