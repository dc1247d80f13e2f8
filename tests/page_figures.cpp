// Compares the figures of studies/findings with the tables that they are taken from, or puts them there.
#include "tests/runners/command/page_figures.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

#include "tests/places.hpp"

namespace fs = std::filesystem;
using namespace ricochet::tests;

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  if (what != "check" && what != "fill") {
    std::cerr << "usage: page_figures check|fill FOLDER [STUDY…]\n"
                 "FOLDER/STUDY receives the results of studies that are not there yet\n";
    return 2;
  }
  const fs::path root = places().source;
  const TablesOf tables = tables_in(argv[2], [&](const std::string& study) {
    std::cerr << "running " << study << "\n";
    const std::string command = "'" + places().command + "' run '" + (root / "studies" / (study + ".json")).string() +
                                "' --out '" + (fs::path(argv[2]) / study).string() + "' >/dev/null 2>&1";
    // Some cases may have failed: the page says how many.
    if (std::system(command.c_str()) < 0) throw std::runtime_error("cannot run " + command);
  });
  int figures = 0;
  std::size_t wrong = 0;
  for (const fs::path& page : pages_of_findings(root)) {
    std::ostringstream text;
    text << std::ifstream(page, std::ios::binary).rdbuf();
    const PageFigures compared = compare_page(text.str(), tables, {argv + 3, argv + argc});
    for (const std::string& sentence : compared.wrong)
      std::cout << page.lexically_relative(root).string() << ", " << sentence << "\n";
    if (what == "fill") std::ofstream(page, std::ios::binary) << compared.text;
    figures += compared.figures;
    wrong += compared.wrong.size();
  }
  std::cout << figures << " figures, " << wrong << (what == "fill" ? " put right\n" : " wrong\n");
  return what == "check" && wrong > 0 ? 1 : 0;
}
