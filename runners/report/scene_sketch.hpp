#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ricochet::report {

/// What is simulated, drawn from a resolved study: structure, clamp, stops with their gaps where they stand, what
/// shakes it. Lengths along the structure are to scale, gaps among each other; gaps and structure are not. An SVG that
/// takes its colours from the page; "" for a study without a scene. `narrow`: with larger letters, for a phone.
std::string scene_svg(const nlohmann::ordered_json& study, bool narrow = false);

/// A key of a scene with its value, as the study format declares it: {"L", "1.501 m"}. What the study varies is said as
/// "from … to … (8 values)".
struct SceneNumber {
  std::string symbol;   ///< "" where the value says what it is
  std::string text;     ///< SI
  std::string pointer;  ///< into the study
  bool entry = false;   ///< one of a list or a body, with all that it holds: "stop wall"
};
/// All that a scene says, in the order of the format. Left out are keys at their defaults, motions and forces without
/// amplitude, and what this program cannot read. Of a beam EI and ρS stand there too.
std::vector<SceneNumber> scene_numbers(const nlohmann::ordered_json& study);
/// Symbols and texts in a line: "L 1.501 m, E 2e11 Pa".
std::string in_a_line(const std::vector<SceneNumber>& numbers);

/// A number, the first of a list; nothing for what is none.
std::optional<double> first_number(const nlohmann::ordered_json* value);
/// The number of an object at a key.
std::optional<double> number_at(const nlohmann::ordered_json& object, const char* key);

/// A place as a study writes it, in words: "x = 0.5 m", "N3 uy", "point plate1".
std::string place_words(const nlohmann::ordered_json& place);

/// The scene of a resolved study, read leniently. What a study varies stands there as a list. What cannot be read is
/// left out of the drawing rather than being an error.
class SceneValues {
 public:
  /// `structure`: where what /scene/structure means here stands, of one body of several.
  explicit SceneValues(const nlohmann::ordered_json& study, std::string structure = "/scene/structure")
      : study_(study), structure_(std::move(structure)) {}

  /// The same scene as each of its bodies sees it, by name; of one structure that, without a name.
  std::vector<std::pair<std::string, SceneValues>> bodies() const;
  /// What stands at a pointer; null where nothing does.
  const nlohmann::ordered_json* at(const std::string& pointer) const;
  std::string word(const std::string& pointer) const;
  /// The number there, the first of a list; nothing for what is none.
  std::optional<double> number(const std::string& pointer) const;
  /// It with its unit; of several "from … to … (8 values)"; "" for nothing and for a lone 0.
  std::string text(const std::string& pointer, const std::string& unit) const;
  /// The same, and a 0 is one. A list is said in full unless its values vary: 0.5, 1 and 2 m.
  std::string said(const std::string& pointer, const std::string& unit, bool varies = true) const;
  /// The values that a sweep gives to this place.
  std::vector<double> swept(const std::string& pointer) const;

  /// A stop: its places as a study writes them, and how far it lies from rest.
  struct Stop {
    nlohmann::ordered_json at, to = {};          ///< to: null for the ground
    std::optional<double> lower, upper, radius;  ///< radius: of a clearance
    std::string name = {};                       ///< where it has one
    std::optional<double> pressed = {};          ///< N, of a friction damper, which has no bounds
  };
  /// The stops, of a list all; else at most twelve places of a structure this long; none where there is no contact.
  std::vector<Stop> stops(double length) const;
  /// EI (N m²) and ρS (kg/m) of a beam; nothing where its section varies or is none.
  struct Section {
    double EI, rhoS;
  };
  std::optional<Section> section() const;

 private:
  /// Where a pointer leads in the study.
  std::string real(const std::string& pointer) const;

  const nlohmann::ordered_json& study_;
  std::string structure_;
};

}  // namespace ricochet::report
