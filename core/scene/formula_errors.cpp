#include <fmt/format.h>
#include <muParser.h>

#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/formula_errors.hpp>

namespace ricochet {
namespace {

bool has_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

void require_expression(const std::string& text, const std::string& pointer) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(pointer, "the formula is empty; expected a number or a formula such as \"0.04*x^2\"");
  constexpr std::size_t longest = mu::MaxLenExpression - 1;
  if (text.size() > longest)
    throw InputError(
        pointer, fmt::format("the formula \"{}\" has {} characters; expected at most {}: shorten it{}", shortened(text),
                             text.size(), longest,
                             pointer.starts_with("/scene/load") ? ", or give a list of several loads" : ""));
  if (has_assignment(text))
    throw InputError(
        pointer, fmt::format("the formula \"{}\" assigns with =; expected an expression, comparisons are written ==",
                             shortened(text)));
}

void explain_formula(const mu::Parser& parser, const mu::ParserError& error, const std::string& text,
                     const std::string& pointer, std::vector<std::string> names, const std::string& names_in_words) {
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
    names.insert(names.end(), {"pi", "e"});
    for (const auto& function : parser.GetFunDef()) names.push_back(function.first);
    // A single letter is near every other one: no guess.
    const std::string nearest = error.GetToken().size() > 1 ? nearest_name(error.GetToken(), names) : "";
    throw InputError(pointer, fmt::format("unknown name \"{}\" in the formula \"{}\"; {}, the constants are pi and e{}",
                                          shortened(error.GetToken()), shortened(text), names_in_words,
                                          nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
  }
  std::string message = error.GetMsg();
  // It quotes what it met.
  const std::string token = error.GetToken();
  if (const auto at = message.find(token); !token.empty() && at != std::string::npos)
    message.replace(at, token.size(), shortened(token));
  while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
  const bool product = error.GetCode() == mu::ecUNEXPECTED_VAR || error.GetCode() == mu::ecUNEXPECTED_FUN ||
                       error.GetCode() == mu::ecUNEXPECTED_VAL || error.GetCode() == mu::ecUNEXPECTED_PARENS;
  throw InputError(pointer, fmt::format("the formula \"{}\" does not parse: {}{}", shortened(text), message,
                                        product ? "; a product is written with *" : ""));
}

}  // namespace ricochet
