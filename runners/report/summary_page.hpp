#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "runners/report/choices.hpp"
#include "runners/store/record.hpp"

namespace ricochet::report {

/// The sentences of the table `answers`, in its order.
std::vector<std::string> answer_lines(const StudyResults& results);

/// How many cases ended so: done, refused, diverged, failed, in this order; none that no case has.
std::vector<std::pair<Status, size_t>> status_counts(const StudyResults& results);

/// "20 done, 4 refused".
std::string statuses_text(const StudyResults& results);

/// "24 cases: 20 done, 4 refused."
std::string counts_text(const StudyResults& results);

/// Sixteen hexadecimal digits that tell studies apart by what was asked and what answered: the resolved study, the
/// commit, the plugins' bytes.
std::string study_fingerprint(const StudyResults& results);

/// What a file of qualification keeps of a study, made to fit one sheet. Its parts: question, sketch of the scene with
/// its numbers, answer, measures (HTML of the kind), place for the figure, methods, limits, identity. The first page of
/// a printed report.
std::string summary_html(const Choices& choices, const std::string& measures = "");

/// The style of the printed pages' margins: which study, which fingerprint, when it ran, which page of how many.
std::string page_margins(const StudyResults& results);

/// A study of a page that lists several: its results, and its report as the page links to it.
struct IndexEntry {
  StudyResults results;
  std::string link;
};

/// One HTML file with a row per study: name, question, answer, cases by status, when it ran. In the style of reports.
std::string index_page(const std::vector<IndexEntry>& studies);
/// The same in Markdown, for a page of text: name, question, cases by status, every line of the answer; no dates, no
/// links.
std::string index_markdown(const std::vector<IndexEntry>& studies);

}  // namespace ricochet::report
