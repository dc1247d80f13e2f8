#include "runners/report/derived/shown_tables.hpp"
#include "runners/report/effects_words.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_shares = 12;  // that a chart shows

}  // namespace

DerivedTable effects_said(const CaseView& view) {
  DerivedTable out{"effects_said", {"measure", "log", "sentence", "caveats", "rest", "rest_share"}, {}};
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
