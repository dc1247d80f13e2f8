#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace ricochet::report {

/// Text as HTML text or as a quoted attribute: & < > " ' escaped, bytes that are no UTF-8 replaced by U+FFFD.
std::string escape(std::string_view text);

/// JSON that may stand inside a <script> element: no '<' appears raw, so neither "</script" nor "<!--" can.
std::string script_json(const nlohmann::ordered_json& value);

/// JavaScript that may stand inside a <script> element: "</script" becomes "<\/script", "<!--" becomes "<\!--" (both
/// the same inside a string, and neither occurs elsewhere in a program).
std::string script_text(std::string_view program);

/// `digits` significant digits, exponents short: "0.02431", "1.2e-7".
std::string number_text(double value, int digits = 4);

/// The shortest text that reads back as the same number: "0.25", "1e-7".
std::string exact_text(double value);

/// An energy ratio in per cent with enough digits to see how far it is from 1: 0.9999876 → "99.9988 %", 0.7 → "70.00
/// %".
std::string percent_text(double ratio);

/// A share in per cent to three significant digits, however small: 0.05 → "5 %", 2.4e-9 → "2.4e-7 %".
std::string share_text(double share);
/// The same with its interval, where there is one: "65 % (60 % to 71 %)".
std::string share_text(double share, std::optional<double> low, std::optional<double> high);

/// Legend symbol of a status: ✓ done, ⊘ refused, ✕ diverged, ! failed; a question mark for an unknown one.
std::string status_mark(const std::string& status);

/// The name of a column as words: "energy_end" → "energy end".
std::string in_words(std::string name);
/// "a, b, c and 4 more".
std::string list_text(std::vector<std::string> items, size_t most = 6);

/// "1 case", "3 cases".
std::string count_text(size_t count, std::string_view singular, std::string_view plural);

}  // namespace ricochet::report
