#pragma once
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/status.hpp"

namespace ricochet::report {

/// What a template is filled with: texts, truth values, lists and objects of these.
using Fill = kainjow::mustache::data;

/// The template of templates/NAME.html, filled: {{x}} is escaped, {{{x}}} is HTML already.
std::string filled(std::string_view name, const Fill& with);

/// Text as HTML text or as a quoted attribute: & < > " ' escaped, bytes that are no UTF-8 replaced by U+FFFD.
std::string escape(std::string_view text);

/// Text, escaped, in which no line ends within a number: a page breaks lines behind the "-" of "1e-4".
std::string unbroken(const std::string& text);

/// JSON that may stand inside a <script> element: no '<' appears raw, so neither "</script" nor "<!--" can.
std::string script_json(const nlohmann::ordered_json& value);

/// JavaScript that may stand inside a <script> element: "</script" becomes "<\/script", "<!--" becomes "<\!--" (both
/// the same inside a string, and neither occurs elsewhere in a program).
std::string script_text(std::string_view program);

/// `digits` significant digits, exponents short: "0.02431", "1.2e-7".
std::string number_text(double value, int digits = 4);

/// The shortest text that reads back as the same number: "0.25", "1e-7".
std::string exact_text(double value);

/// A share in per cent to three significant digits, however small: 0.05 → "5 %", 2.4e-9 → "2.4e-7 %".
std::string share_text(double share);
/// The same with its interval, where there is one: "65 % (60 % to 71 %)".
std::string share_text(double share, std::optional<double> low, std::optional<double> high);

/// Legend symbol of a status: ✓ done, ⊘ refused, ✕ diverged, ! failed; a question mark for an unknown one.
std::string status_mark(Status status);

/// The name of a column as words: "energy_end" → "energy end", "peak_force[plate]" → "peak force at plate".
std::string in_words(std::string name);
/// "a, b, c and 4 more".
std::string list_text(std::vector<std::string> items, size_t most = 6);

/// "1 case", "3 cases".
std::string count_text(size_t count, std::string_view singular, std::string_view plural);

/// A patch of a colour before a word that it stands for.
std::string swatch(std::string_view colour);

/// A table of a page, put together row by row. What is given as text is escaped; what is missing is a dash.
class HtmlTable {
 public:
  struct Head {
    std::string text;
    bool number = false;
    std::string tooltip = "", colour = "";
  };
  /// `caption` is HTML.
  explicit HtmlTable(std::string caption, std::vector<Head> heads = {}, std::string classes = "matrix")
      : caption_(std::move(caption)), heads_(std::move(heads)), classes_(std::move(classes)) {}

  void add(Head head) { heads_.push_back(std::move(head)); }
  /// Begins a row.
  HtmlTable& row();
  /// Begins a row with what it is about, behind a swatch where there is a colour; `html` follows it as it is.
  HtmlTable& row(std::string_view head, std::string_view colour = "", std::string_view html = "");
  HtmlTable& text(std::string_view text, std::string_view classes = "", std::string_view tooltip = "");
  /// A number with so many digits, all of them in its tooltip.
  HtmlTable& number(std::optional<double> value, int digits = 6);
  /// A number as it is to be read: "12 %", "0.99 ✓".
  HtmlTable& number(std::string_view text, std::string_view tooltip = "", std::string_view classes = "");
  /// A cell without a value.
  HtmlTable& absent(bool number = true, std::string_view text = "–");
  /// A cell of HTML with these attributes.
  HtmlTable& cell(std::string_view html, std::string_view attributes = "");

  std::size_t size() const { return rows_.size(); }
  /// "" without rows; more than 24 fold under their caption; so many at most, and how many more its CSV file has.
  std::string html(std::size_t most = 100) const;

 private:
  std::string caption_;
  std::vector<Head> heads_;
  std::string classes_;
  std::vector<std::string> rows_;
};

}  // namespace ricochet::report
