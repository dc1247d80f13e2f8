#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet::report {

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
