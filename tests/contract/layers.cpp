// Read from the sources: who may include whom, and that nobody knows a method by name.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <map>
#include <regex>
#include <ricochet/loader/catalogue.hpp>
#include <set>
#include <sstream>

#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
namespace fs = std::filesystem;

namespace {

const fs::path root = tests::places().source;

struct Source {
  std::string name;  ///< from the root
  std::string text;
};

std::vector<Source> sources(const std::string& folder) {
  std::vector<Source> result;
  for (auto item = fs::recursive_directory_iterator(root / folder); item != fs::recursive_directory_iterator();
       ++item) {
    if (item->path().filename() == "node_modules") {
      item.disable_recursion_pending();
      continue;
    }
    const std::set<std::string> code = {".cpp", ".hpp", ".js", ".in"};
    if (code.count(item->path().extension().string()))
      result.push_back({fs::relative(item->path(), root).string(), read_text(item->path())});
  }
  std::sort(result.begin(), result.end(), [](const Source& a, const Source& b) { return a.name < b.name; });
  return result;
}

// "<fmt/format.h>" or "\"runners/study/study.hpp\"", as they are spelled.
std::vector<std::string> includes(const Source& source) {
  std::vector<std::string> result;
  std::size_t at = 0;
  while (at < source.text.size()) {
    std::size_t end = source.text.find('\n', at);
    if (end == std::string::npos) end = source.text.size();
    std::string line = source.text.substr(at, end - at);
    at = end + 1;
    line.erase(std::remove_if(line.begin(), line.end(), [](unsigned char c) { return std::isspace(c); }), line.end());
    if (!line.starts_with("#include")) continue;
    const std::size_t close = line.find_first_of(">\"", 9);
    REQUIRE(close != std::string::npos);
    result.push_back(line.substr(8, close - 7));
  }
  return result;
}

/// Names of sources in the comments of a file: "(store.hpp)", "runners/store/store.hpp".
std::vector<std::string> named_sources(const std::string& text) {
  static const std::regex name(R"(([a-z_\-]+)\.(hpp|cpp)\b)");
  std::vector<std::string> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t comment = line.find("//"); comment != std::string::npos)
      for (std::sregex_iterator at(line.begin() + static_cast<std::ptrdiff_t>(comment), line.end(), name), end;
           at != end; ++at)
        result.push_back(at->str());
  return result;
}

/// A string literal and the last characters of code before it.
struct Literal {
  std::string text, before;
};

// The string literals of C++ and JavaScript, comments left out.
std::vector<Literal> literals(const std::string& text) {
  std::vector<Literal> result;
  std::string before;
  const auto from = [&](std::size_t at, const std::string& end) {
    const std::size_t found = text.find(end, at);
    return found == std::string::npos ? text.size() : found;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (text.compare(i, 2, "//") == 0) {
      i = from(i, "\n");
    } else if (text.compare(i, 2, "/*") == 0) {
      i = from(i + 2, "*/") + 1;
    } else if (c == '"' && before.ends_with("R")) {
      const std::size_t open = from(i, "(");
      const std::size_t close = from(open, ")" + text.substr(i + 1, open - i - 1) + "\"");
      result.push_back({text.substr(open + 1, close - open - 1), before});
      i = close + open - i;
      before.clear();
    } else if (c == '"' ||
               (c == '\'' && (before.empty() || !std::isalnum(static_cast<unsigned char>(before.back()))))) {
      std::string literal;
      for (++i; i < text.size() && text[i] != c && text[i] != '\n'; ++i) {
        if (text[i] == '\\') ++i;
        if (i < text.size()) literal += text[i];
      }
      result.push_back({literal, before});
      before.clear();
    } else if (!std::isspace(static_cast<unsigned char>(c))) {
      before += c;
      if (before.size() > 8) before.erase(0, 1);
    }
  }
  return result;
}

bool has_word(const std::string& text, const std::string& word) {
  const auto inside = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !inside(text[at - 1])) && (end == text.size() || !inside(text[end]))) return true;
  }
  return false;
}

std::set<std::string> method_names() {
  const Catalogue catalogue(tests::places().plugins, {}, {});
  std::set<std::string> names;
  for (const Provided& method : catalogue.provided()) names.insert(method.name);
  return names;
}

// "reference" of "plugins/reference/exact/exact.cpp".
std::string role_of(const std::string& plugin) {
  return (++fs::path(plugin).begin())->string();
}

// "core/measure" of "core/measure/energy/energy_audit.cpp".
std::string folder_of(const std::string& source) {
  return source.substr(0, source.find('/', source.find('/') + 1));
}

// Folder "core/contract" or "runners/study" of an include, "" for libraries.
std::string layer_of(const std::string& include) {
  for (const auto& [prefix, layer] :
       std::map<std::string, std::string>{{"<ricochet/", "core/"}, {"\"runners/", "runners/"}})
    if (include.starts_with(prefix)) {
      const std::size_t slash = include.find('/', prefix.size());
      return layer + include.substr(prefix.size(), slash - prefix.size());
    }
  return "";
}

}  // namespace

TEST_CASE("the scanner of this test sees literals and not comments") {
  const auto found = literals(R"x(a == "one"; // "two"
    /* "three" */ f("fo\"ur", 'c', 1'000, R"(fi"ve)");)x");
  std::vector<std::string> texts;
  for (const Literal& literal : found) texts.push_back(literal.text);
  CHECK(texts == std::vector<std::string>{"one", "fo\"ur", "c", "fi\"ve"});
  CHECK(found[0].before == "a==");
  CHECK(has_word("use penalty here", "penalty"));
  CHECK_FALSE(has_word("penalty-like", "penalty"));
  CHECK_FALSE(has_word("newmark-dumont-paoli", "newmark"));
  REQUIRE(sources("core").size() > 20);
  REQUIRE(sources("plugins").size() >= 10);
  REQUIRE(sources("runners").size() > 20);
  REQUIRE(method_names().size() >= 10);
}

TEST_CASE(
    "plugins include the contract, kernels and contact solvers, their own headers, the standard library, Eigen and "
    "fmt") {
  for (const Source& source : sources("plugins"))
    for (const std::string& include : includes(source)) {
      INFO(source.name << " includes " << include);
      // A header of the method's own folder, or one that methods of its role share (plugins/ROLE).
      const bool bare = include[0] == '"' && include.find('/') == std::string::npos;
      const std::string header = include.substr(1, include.size() - 2);
      const fs::path folder = (root / source.name).parent_path(), role = root / "plugins" / role_of(source.name);
      const bool own = bare && (fs::exists(folder / header) || fs::exists(role / header));
      const bool standard = include[0] == '<' && include.find_first_of("/.") == std::string::npos;
      CHECK((standard || include.starts_with("<ricochet/contract/") || include.starts_with("<ricochet/kernels/") ||
             include.starts_with("<ricochet/contact_solvers/") || include.starts_with("<Eigen/") ||
             include.starts_with("<fmt/") || own));
    }
}

TEST_CASE("core and runners include no plugin, and core no runner") {
  for (const std::string folder : {"core", "runners"})
    for (const Source& source : sources(folder))
      for (const std::string& include : includes(source)) {
        INFO(source.name << " includes " << include);
        CHECK(include.find("plugins/") == std::string::npos);
        if (folder == "core") {
          CHECK(include[0] == '<');
          CHECK(include.find("runners/") == std::string::npos);
        }
      }
}

TEST_CASE("folders include what lies below them, and every folder has its rule") {
  const std::map<std::string, std::set<std::string>> below = {
      {"core/contract", {}},
      {"core/loader", {"core/contract"}},
      {"core/kernels", {"core/contract", "core/loader"}},
      {"core/contact_solvers", {"core/contract", "core/kernels"}},
      {"core/scene", {"core/contract", "core/kernels", "core/contact_solvers"}},
      {"core/engine", {"core/contract", "core/kernels", "core/contact_solvers", "core/scene"}},
      {"core/measure", {"core/contract", "core/kernels", "core/contact_solvers", "core/scene", "core/engine"}},
      {"runners/table", {"core/contract"}},
      {"runners/json", {"core/contract", "runners/table"}},
      {"runners/plan_files", {"core/contract", "core/loader", "core/scene", "runners/table", "runners/json"}},
      {"runners/study",
       {"core/contract", "core/loader", "core/scene", "core/engine", "runners/table", "runners/json",
        "runners/plan_files"}},
      {"runners/store", {"core/contract", "core/loader", "runners/table", "runners/study"}},
      {"runners/march",
       {"core/contract", "core/engine", "core/measure", "core/scene", "runners/table", "runners/study",
        "runners/store"}},
      {"runners/report", {"core/contract", "core/scene", "runners/table", "runners/study", "runners/store"}},
      {"runners/answers", {"core/measure", "runners/table", "runners/study", "runners/store", "runners/report"}},
      {"runners/asks",
       {"core/measure", "runners/table", "runners/json", "runners/study", "runners/store", "runners/report",
        "runners/answers"}},
      {"runners/kinds",
       {"runners/answers", "runners/asks", "core/contract", "core/loader", "core/scene", "core/engine", "core/measure",
        "runners/table", "runners/json", "runners/plan_files", "runners/study", "runners/store", "runners/march",
        "runners/report"}},
      {"runners/workers",
       {"core/contract", "core/engine", "core/loader", "runners/table", "runners/plan_files", "runners/study",
        "runners/store", "runners/march", "runners/kinds"}},
      {"runners/run",
       {"runners/answers", "runners/asks", "core/contract", "core/loader", "core/kernels", "core/scene", "core/measure",
        "runners/table", "runners/json", "runners/study", "runners/store", "runners/march", "runners/kinds",
        "runners/workers", "runners/report"}},
      {"runners/pack", {"core/contract", "runners/table", "runners/study", "runners/store"}},
      {"runners/check",
       {"core/contract", "core/loader", "core/kernels", "core/contact_solvers", "core/scene", "core/engine",
        "core/measure", "runners/plan_files", "runners/study"}},
      {"runners/command",
       {"runners/asks", "core/contract", "core/loader", "core/scene", "core/measure", "runners/table",
        "runners/plan_files", "runners/study", "runners/store", "runners/march", "runners/kinds", "runners/workers",
        "runners/run", "runners/report", "runners/check", "runners/pack"}},
      {"runners/mpi", {"runners/workers", "runners/command"}},
  };
  for (const std::string folder : {"core", "runners"})
    for (const Source& source : sources(folder)) {
      if (!source.name.ends_with(".cpp") && !source.name.ends_with(".hpp")) continue;
      const std::string layer = folder_of(source.name);
      INFO(source.name);
      REQUIRE(below.count(layer) == 1);
      for (const std::string& include : includes(source)) {
        const std::string other = layer_of(include);
        INFO("includes " << include);
        CHECK((other.empty() || other == layer || below.at(layer).count(other)));
      }
    }
}

TEST_CASE("a kind of study is known by name in the folders of the kinds alone") {
  std::set<std::string> kinds;
  for (const auto& folder : fs::directory_iterator(root / "runners" / "kinds"))
    if (folder.is_directory()) kinds.insert(folder.path().filename().string());
  REQUIRE(kinds.count("bifurcation") == 1);
  for (const std::string folder : {"core", "runners"})
    for (const Source& source : sources(folder)) {
      if (folder_of(source.name) == "runners/kinds") continue;
      for (const Literal& literal : literals(source.text)) {
        INFO(source.name << ": \"" << literal.text << '"');
        CHECK(kinds.count(literal.text) == 0);
      }
    }
}

TEST_CASE("core and runners know no method by name") {
  // These are words of every day as well; they may stand in a sentence.
  const std::set<std::string> ordinary = {"consistent", "damper",  "exact",    "layer",  "limited", "lumped",
                                          "none",       "penalty", "singular", "spring", "table"};
  // The study format has one method by default: how stops rub.
  const auto of_the_format = [](const Source& source, const std::string& name) {
    return name == "coulomb" && source.name.starts_with("runners/study/");
  };
  // "exact" is how well a scheme keeps the restitution coefficient. "none" is also what a
  // table shows for no value, and a projection of the initial state. "layer" is a function of every law, "table" a kind
  // of parameter. They may stand alone where nothing is decided by them.
  const auto decides = [](const std::string& before) {
    return before.ends_with("==") || before.ends_with("!=") || before.ends_with("compare(") ||
           before.ends_with("count(") || before.ends_with("find(") || before.ends_with("case") ||
           before.ends_with("contains(");
  };
  const std::set<std::string> names = method_names();
  for (const std::string folder : {"core", "runners"})
    for (const Source& source : sources(folder))
      for (const Literal& literal : literals(source.text))
        for (const std::string& name : names) {
          const bool exact = literal.text == name &&
                             (!std::set<std::string>{"none", "exact", "layer", "spring", "table"}.count(name) ||
                              decides(literal.before));
          const bool named = !ordinary.count(name) && has_word(literal.text, name);
          if ((exact || named) && !of_the_format(source, name))
            FAIL_CHECK(source.name << " names the method " << name << ": \"" << literal.text << '"');
        }
}

TEST_CASE("lambdas of kernels are inlined, whatever the compiler does of itself") {
  // A call would pass a vector as the caller's instruction set has it, and take it as the callee's.
  const std::regex called(R"(\[[^\]\[]*\]\s*(\([^()]*\)\s*)?\{)");
  int kernels = 0;
  for (const Source& source : sources("core/kernels")) {
    const std::string name = fs::path(source.name).filename().string();
    if (!name.starts_with("lane_") && source.text.find("vector_size") == std::string::npos) continue;
    ++kernels;
    std::smatch found;
    INFO(source.name);
    CHECK_FALSE(std::regex_search(source.text, found, called));
  }
  CHECK(kernels > 5);
}

TEST_CASE("comments name sources that exist") {
  const std::vector<std::string> folders = {"core", "plugins", "runners", "tests"};
  std::set<std::string> there;
  for (const std::string& folder : folders)
    for (const Source& source : sources(folder)) there.insert(fs::path(source.name).filename().string());
  for (const std::string& folder : folders)
    for (const Source& source : sources(folder))
      for (const std::string& name : named_sources(source.text)) {
        INFO(source.name << " names " << name);
        CHECK(there.contains(name));
      }
}

TEST_CASE("scripts have at most 120 columns") {
  const auto begins = [](unsigned char c) { return (c & 0xC0U) != 0x80U; };  // bytes that begin a character of UTF-8
  for (const std::string folder : {"core", "plugins", "runners"})
    for (const Source& source : sources(folder)) {
      if (!source.name.ends_with(".js")) continue;
      std::istringstream lines(source.text);
      int count = 0;
      for (std::string line; std::getline(lines, line);) {
        INFO(source.name << ':' << ++count);
        CHECK(std::count_if(line.begin(), line.end(), begins) <= 120);
      }
    }
}
