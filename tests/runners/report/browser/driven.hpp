#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// \file
/// Reports read as people read them: on a phone with a finger, on paper, on a dark screen, by keys. See drive.js.
namespace ricochet::browser {

/// The width of a page as it is laid out, an expression that drive.js evaluates.
inline constexpr const char* page_width = "document.documentElement.scrollWidth";

/// The report of a study of tests/runners/report/studies that the command ran in a folder. It is run once for all
/// tests, and anew when the command, its methods or the study are newer.
std::string report_of(const std::string& folder, const std::string& kind);

/// What drive.js answers to these steps, by their names; fails where a page met an error.
nlohmann::json driven(const std::string& folder, const nlohmann::json& steps);

/// What a shell command says; fails where it does.
std::string words_of(const std::string& command);

}  // namespace ricochet::browser
