#include "runners/command/figure_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "runners/report/ask_figure.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "runners/store/temporary_folder.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

/// What a command writes; its own errors are left out.
std::string output_of(const std::string& command) {
  std::string out;
  std::FILE* pipe = ::popen((command + " 2>/dev/null </dev/null").c_str(), "r");
  if (!pipe) return out;
  char buffer[65536];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, count);
  ::pclose(pipe);
  return out;
}

std::string browser() {
  const char* said = std::getenv("RICOCHET_BROWSER");
  if (said && *said) {
    if (output_of(fmt::format("command -v {}", shell_quoted(said))).empty())
      throw StoreError(fmt::format("RICOCHET_BROWSER names \"{}\", and there is no such program", said));
    return said;
  }
  for (const char* name : {"chromium", "chromium-browser", "google-chrome", "microsoft-edge"})
    if (!output_of(fmt::format("command -v {}", name)).empty()) return name;
  throw StoreError(
      "figures are drawn by a browser, and none was found: install chromium, or name one of its kind in "
      "RICOCHET_BROWSER");
}

/// A file's address: what is no plain letter is %xx.
std::string address_of(const fs::path& file) {
  std::string out = "file://";
  for (const char c : fs::canonical(file).string())
    out += std::isalnum(static_cast<unsigned char>(c)) || std::string_view("-._~/").find(c) != std::string_view::npos
               ? std::string(1, c)
               : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace

std::string figure_file_name(const std::string& name, std::set<std::string>& taken) {
  constexpr std::string_view sign = "−";
  std::string out;
  const auto gap = [&] {
    if (!out.empty() && out.back() != '-') out += '-';
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto letter = [&](std::size_t k) {
      return k < name.size() && std::isalnum(static_cast<unsigned char>(name[k])) != 0;
    };
    const bool hyphen = name[i] == '-' && letter(i + 1) && (i == 0 || !letter(i - 1));
    if (hyphen || name.compare(i, sign.size(), sign) == 0) {
      gap();
      out += "minus";
      i += hyphen ? 0 : sign.size() - 1;
    }
    if (letter(i) || name[i] == '.')
      out += name[i];
    else
      gap();
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  std::string own = out;
  for (int k = 2; !taken.insert(own).second; ++k) own = fmt::format("{}-{}", out, k);
  return own;
}

std::size_t write_figures(const fs::path& report, const fs::path& folder) {
  const TemporaryFolder profile("figures");
  // The superuser's browser has no sandbox; the page is ours, and forbids the network.
  const std::string start = fmt::format(
                        "{} --headless --disable-gpu --no-first-run --window-size=1400,1000 {} --user-data-dir={}",
                        shell_quoted(browser()), ::geteuid() == 0 ? "--no-sandbox" : "", profile.path().string()),
                    page = address_of(report);
  const std::string read = output_of(fmt::format("{} --dump-dom {}", start, shell_quoted(page + "#export"))),
                    opening = "id=\"exported\">";
  const std::size_t from = read.find(opening);
  const auto figures = from == std::string::npos
                           ? nlohmann::json()
                           : nlohmann::json::parse(read.substr(from + opening.size(),
                                                               read.find("</script>", from) - from - opening.size()),
                                                   nullptr, false);
  if (!figures.is_array()) throw StoreError(fmt::format("{} drew no figures of {}", browser(), report.string()));
  make_folder(folder);
  std::set<std::string> taken;
  for (const auto& figure : figures) {
    const fs::path file = folder / figure_file_name(figure.at("name"), taken);
    write_file(file.string() + ".svg", figure.at("svg").get_ref<const std::string&>());
    write_file(file.string() + ".csv", figure.at("csv").get_ref<const std::string&>());
  }
  // The figures of answers by all digits of their numbers: the page has them as text.
  const AnalysedResults results(read_what_is_whole(report.parent_path()));
  for (std::size_t k = 0; k < results.asked.all.size(); ++k)
    if (const fs::path file = folder / fmt::format("ask-{}.csv", k + 1); fs::exists(file))
      if (const std::string text = report::figure_csv(results.asked.all[k].second.figure); !text.empty())
        write_file(file, text);
  if (figures.empty()) return 0;
  const fs::path sheets = folder / "figures.pdf";
  std::error_code ignored;
  fs::remove(sheets, ignored);
  output_of(fmt::format("{} --no-pdf-header-footer --print-to-pdf={} {}", start,
                        shell_quoted(fs::absolute(sheets).string()), shell_quoted(page + "#export-pages")));
  if (!fs::exists(sheets)) throw StoreError(fmt::format("{} made no {}", browser(), sheets.string()));
  return figures.size();
}

}  // namespace ricochet
