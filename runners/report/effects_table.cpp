#include <fmt/format.h>

#include "runners/report/effects_words.hpp"
#include "runners/report/effects.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {

std::string effects_html(const CaseView& view) {
  const std::vector<MeasureShares> all = measure_shares(view.results());
  if (all.empty()) return "";
  std::string sentences = "<ul class=\"answer\">\n", rows;
  for (const MeasureShares& measure : all) {
    sentences += fmt::format("<li>{}<span class=\"fine\">{}</span></li>\n", escape(effects_sentence(measure)),
                             escape(effects_caveats(view, measure)));
    for (const MeasureShare& share : measure.shares)
      if (share.share >= 1e-3)
        rows += fmt::format(
            "<tr><td>{}</td><td>{}</td><td class=\"number\" title=\"{}\">{}</td><td class=\"number\">{} to "
            "{}</td></tr>\n",
            escape(in_words(measure.name) + (measure.log ? " (log)" : "")), escape(share.factor),
            exact_text(share.share), effects_percent(share.share), effects_percent(share.low),
            effects_percent(share.high));
  }
  sentences += "</ul>\n";
  if (rows.empty()) return sentences;
  return sentences +
         fmt::format(
             "<details><summary>Shares of 0.1 % and more, with 95 % intervals</summary>\n<table "
             "class=\"plain\"><thead><tr><th scope=\"col\">measure</th><th scope=\"col\">choice</th><th scope=\"col\" "
             "class=\"number\">share</th><th scope=\"col\" class=\"number\">interval</th></tr></thead>\n<tbody>\n{}"
             "</tbody></table></details>\n",
             rows);
}

}  // namespace ricochet::report
