#include "runners/report/effects.hpp"
#include "runners/report/effects_words.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_shares = 12;  // that a chart shows

}  // namespace

Table effects_said(const CaseView& view) {
  Table out{"effects_said",
            "One row per measure: what the shares of effects.csv say, in words.",
            {{"measure", "", "Name of the measure, a column of cases.csv."},
             {"log", "", "Whether its logarithm was taken."},
             {"sentence", "", "The largest shares as a sentence."},
             {"caveats", "", "What the shares leave out."},
             {"rest", "1", "Number of small shares that a chart shows together."},
             {"rest_share", "1", "What these explain together."}},
            {}};
  for (const MeasureShares& measure : measure_shares(view.results())) {
    size_t rest = 0;
    double together = 0;
    for (size_t k = most_shares; k < measure.shares.size(); ++k) {
      ++rest;
      together += measure.shares[k].share;
    }
    out.rows.push_back(
        {measure.name, measure.log, effects_sentence(measure), effects_caveats(view, measure), rest, together});
  }
  return out;
}

}  // namespace ricochet::report
