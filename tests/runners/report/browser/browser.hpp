#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// Reports opened in headless Chromium: what is drawn is read back from the charts.
namespace ricochet::browser {

using Json = nlohmann::json;

/// A report to open.
struct Page {
  std::string name, html;
  bool controls = true;                                 ///< legend, zoom, pictures, panels are worked as well
  std::vector<std::pair<double, double>> numbers = {};  ///< written and rounded by the page's script
};

/// The report of these results.
Page page_of(const std::string& name, const StudyResults& results);

/// Whether RICOCHET_WITHOUT_BROWSER leaves these checks out; a missing browser is a failure.
bool left_out();

/// Opens all pages in one browser and returns by name what probe.js read of each; fails where one met an error.
Json read_back(const std::string& folder, const std::vector<Page>& pages);

/// A figure by its id; fails where there is none.
const Json& figure(const Json& page, const std::string& id);
bool has_figure(const Json& page, const std::string& id);

/// Series in one view of all charts of a figure that `accept` takes.
using Accept = std::function<bool(const Json& series)>;
std::vector<Json> series_of(const Json& figure, size_t view, const Accept& accept);
/// Their items.
std::vector<Json> items_of(const Json& figure, size_t view, const Accept& accept);

/// Curves with marks on their points, text marks, series of a name.
bool is_curve(const Json& series);
bool is_mark(const Json& series);
Accept named(const std::string& name);

/// Whether some text of a list has a part.
bool says(const Json& texts, const std::string& part);

/// That each chart is drawn in each view, and that the page's controls did what they say.
void require_works(const Json& page, size_t cases);

/// That a click on a dot of each figure, or Enter on the row of a case, opens the case; that › and Escape work there.
void require_doors(const Json& page, const std::string& kind);

}  // namespace ricochet::browser
