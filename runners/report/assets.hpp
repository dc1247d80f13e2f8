#pragma once
#include <string_view>

namespace ricochet::report {

/// The files that every report inlines, carried inside the program (see echarts.cmake).
std::string_view page_style();
std::string_view page_script();
/// What page_script() needs of diagrams; goes before it.
std::string_view dynamics_script();

/// The minified chart library, or nothing when the program was built without it.
std::string_view chart_library();
/// Its version as the package says, "" without it.
std::string_view chart_library_version();

}  // namespace ricochet::report
