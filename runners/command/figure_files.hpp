#pragma once
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>

namespace ricochet {

/// A figure's name as that of a file: letters, digits and points, "minus" of a sign. One that is taken gets a number.
std::string figure_file_name(const std::string& name, std::set<std::string>& taken);

/// Writes the figures of a report into `folder`, which is made: NAME.svg and NAME.csv of each, and figures.pdf with a
/// page for each. The page draws them in a browser without a window: RICOCHET_BROWSER, else chromium or a relative of
/// it on PATH. Returns how many there are. Throws StoreError where no browser is found, or it draws nothing.
std::size_t write_figures(const std::filesystem::path& report, const std::filesystem::path& folder);

}  // namespace ricochet
