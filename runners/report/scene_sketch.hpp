#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet::report {

/// What is simulated, drawn from a resolved study: structure, clamp, stops with their gaps where they stand, what
/// shakes it. Lengths along the structure are to scale, gaps among each other; gaps and structure are not. An SVG that
/// takes its colours from the page; "" for a study without a scene.
std::string scene_svg(const nlohmann::ordered_json& study);

/// Its numbers, SI: {"L", "1.501 m"}, {"EI", "33.8 N m²"}, … What the study varies is said as "from … to … (8 values)".
std::vector<std::pair<std::string, std::string>> scene_numbers(const nlohmann::ordered_json& study);

}  // namespace ricochet::report
