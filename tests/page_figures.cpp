// Compares the figures of studies/README.md with the tables that they are taken from, or puts them there.
#include "tests/runners/command/page_figures.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

namespace fs = std::filesystem;
using namespace ricochet::tests;

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  if (what != "check" && what != "fill") {
    std::cerr << "usage: page_figures check|fill FOLDER [STUDY…]\n"
                 "FOLDER/STUDY receives the results of studies that are not there yet\n";
    return 2;
  }
  const fs::path root = RICOCHET_SOURCE_DIR, page = root / "studies/README.md";
  std::ostringstream text;
  text << std::ifstream(page, std::ios::binary).rdbuf();
  const TablesOf tables = tables_in(argv[2], [&](const std::string& study) {
    std::cerr << "running " << study << "\n";
    const std::string command = "'" RICOCHET_COMMAND "' run '" + (root / "studies" / (study + ".json")).string() +
                                "' --out '" + (fs::path(argv[2]) / study).string() + "' >/dev/null 2>&1";
    // Some cases may have failed: the page says how many.
    if (std::system(command.c_str()) < 0) throw std::runtime_error("cannot run " + command);
  });
  const PageFigures found = compare_page(text.str(), tables, {argv + 3, argv + argc});
  for (const std::string& wrong : found.wrong) std::cout << "studies/README.md, " << wrong << "\n";
  std::cout << found.figures << " figures, " << found.wrong.size() << (what == "fill" ? " put right\n" : " wrong\n");
  if (what == "check") return found.wrong.empty() ? 0 : 1;
  std::ofstream(page, std::ios::binary) << found.text;
  return 0;
}
