#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <ostream>
#include <ricochet/loader/installed_folder.hpp>
#include <sstream>

#include "runners/command/command.hpp"
#include "runners/command/examples.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

constexpr const char* plan_word = "plan";

namespace fs = std::filesystem;

/// What `new` was asked for.
struct Wish {
  std::string word;  ///< a role, or "plan"
  Role role;         ///< time, of a plan
  std::string name;
  fs::path program;  ///< this one
  fs::path prefix() const { return program.parent_path().parent_path(); }
};

std::string underscored(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

void check_name(const Wish& wish, const Arguments& arguments) {
  const auto admissible = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
  const std::string& name = wish.name;
  if (name.empty() || name.front() == '-' || !std::all_of(name.begin(), name.end(), admissible))
    throw UsageError("\"" + name +
                     "\" cannot be the name of a method: expected small letters, digits and '-', and no "
                     "'-' at its beginning");
  if (wish.word == plan_word && name == stated_plan)
    throw UsageError("a plan has a name of its own: in a study \"plan\" stands for any scheme given by a file");
  const Catalogue catalogue = standard_catalogue(arguments.plugins);
  for (const Provided& method : catalogue.provided())
    if (method.role == wish.role && method.name == name)
      throw UsageError(
          fmt::format("there is a {} method \"{}\" already, in {}: the first that is found wins, and yours "
                      "would be shadowed by it; choose another name",
                      role_name(wish.role), name, method.file.string()));
  std::error_code ignored;
  if (fs::symlink_status(name, ignored).type() != fs::file_type::not_found)
    throw UsageError("\"" + name + "\" is here already: choose another name, or another folder to make it in");
}

/// The files of an example, and its name: that of its source, or of its plan.
struct Example {
  std::string name;
  std::vector<ExampleFile> files;
};

Example example_of(const std::string& word) {
  Example example;
  for (const ExampleFile& file : example_files()) {
    if (file.role != word) continue;
    example.files.push_back(file);
    if (const fs::path path(file.name);
        path.extension() == (word == plan_word ? ".json" : ".cpp") && path != "study.json")
      example.name = path.stem().string();
  }
  return example;
}

std::string renamed(std::string text, const std::string& from, const Wish& wish) {
  replace_all(text, from, wish.name);
  replace_all(text, underscored(from), underscored(wish.name));
  // The example knows the installation by where it lies in it.
  std::string prefix;
  for (const char c : wish.prefix().string()) {
    if (c == '\\' || c == '"' || c == '$') prefix += '\\';
    prefix += c;
  }
  replace_all(text, "${CMAKE_CURRENT_LIST_DIR}/../../../..", prefix);
  return text;
}

/// A folder that is removed again unless it is given its name.
class Draft {
 public:
  explicit Draft(const std::string& name) : path_(fmt::format(".{}.{}", name, ::getpid())) {
    if (!fs::create_directory(path_)) throw fs::filesystem_error("cannot create", path_, {});
  }
  ~Draft() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  void write(const std::string& name, const std::string& text) const {
    std::ofstream file(path_ / name, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw fs::filesystem_error("cannot write", path_ / name, {});
  }
  void give(const std::string& name) {
    fs::rename(path_, name);
    path_.clear();
  }

 private:
  fs::path path_;
};

std::vector<std::string> make(const Wish& wish, const Example& example) {
  std::vector<std::string> names;
  try {
    Draft draft(wish.name);
    for (const ExampleFile& file : example.files) {
      std::string name(file.name);
      replace_all(name, example.name, wish.name);
      draft.write(name, renamed(std::string(file.text), example.name, wish));
      names.push_back(name);
    }
    draft.give(wish.name);
  } catch (const fs::filesystem_error& error) {
    throw StoreError("the folder \"" + wish.name + "\" cannot be made here: " + error.what());
  }
  return names;
}

/// How the user may call this program from anywhere: by its name where the shell finds it, else by its path.
std::string called(const fs::path& program) {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  std::error_code ignored;
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path found = fs::path(folder) / program.filename();
    if (!fs::exists(found, ignored)) continue;
    if (fs::equivalent(found, program, ignored)) return program.filename().string();
    break;
  }
  const std::string path = program.string();
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/._+-", c); };
  return std::all_of(path.begin(), path.end(), plain) ? path : shell_quoted(path);
}

}  // namespace

int command_new(const Arguments& arguments, std::ostream& out) {
  const std::string& word = arguments.operands[0];
  const bool plan = word == plan_word;
  const Wish wish{word, plan ? Role::time : role_called(word, {plan_word}), arguments.operands[1],
                  fs::read_symlink("/proc/self/exe")};
  check_name(wish, arguments);
  const Example example = example_of(wish.word);
  std::string files;
  for (const std::string& file : make(wish, example)) files += (files.empty() ? "" : ", ") + file;
  const std::string ricochet = called(wish.program);
  const std::string works = fmt::format("{}/ holds {}: the example {} under your name, which works as it stands.",
                                        wish.name, files, example.name);
  if (plan) {
    out << fmt::format(
        "{1} There is nothing to build. Read its step, check it, run its study:\n\n"
        "    {2} describe {0}/{0}.json\n"
        "    {2} check {0}/{0}.json\n"
        "    {2} run {0}/study.json\n",
        wish.name, works, ricochet);
  } else {
    const std::string plugin = fmt::format("{0}/build/plugins/{1}-{0}.so", wish.name, role_name(wish.role));
    out << fmt::format(
        "{3} Build it, check it, run its study:\n\n"
        "    cmake -S {0} -B {0}/build && cmake --build {0}/build\n"
        "    {1} check {2}\n"
        "    {1} run {0}/study.json --plugin {2}\n",
        wish.name, ricochet, plugin, works);
  }
  std::error_code ignored;
  const fs::path page = installed_data() / "plugins" / (plan ? "plan-files.md" : "README.md");
  if (page.is_absolute() && fs::exists(page, ignored))
    out << (plan ? "\nAll keys of a plan: " : "\nWhat the loop does with each field: ") << page.string() << "\n";
  return exit_done;
}

}  // namespace ricochet
