#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// \file
/// Reports read as people read them: on a phone with a finger, on paper, on a dark screen, by keys. See drive.js.
namespace ricochet::browser {

/// Runs a study of tests/runners/report/studies by the command, once per test (its folder); returns its report.
std::string report_of(const std::string& folder, const std::string& kind);

/// What drive.js answers to these steps, by their names; fails where a page met an error.
nlohmann::json driven(const std::string& folder, const nlohmann::json& steps);

}  // namespace ricochet::browser
