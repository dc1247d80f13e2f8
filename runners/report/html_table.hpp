#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet::report {

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
  /// "" without rows; more than 24 fold under their caption; at most 100, and how many more its CSV file has.
  std::string html() const;

 private:
  std::string caption_;
  std::vector<Head> heads_;
  std::string classes_;
  std::vector<std::string> rows_;
};

}  // namespace ricochet::report
