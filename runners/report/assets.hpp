#pragma once
#include <string_view>

namespace ricochet::report {

/// A file that reports inline, carried inside the program (see echarts.cmake): "page.css", "script/page.js",
/// "kinds/tip.js" (whatever the folder of the kind). Empty for a name that it does not carry.
std::string_view asset(std::string_view name);

/// The minified chart library, or nothing when the program was built without it.
std::string_view chart_library();
/// Its version as the package says, "" without it.
std::string_view chart_library_version();

}  // namespace ricochet::report
