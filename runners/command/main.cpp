#include <iostream>

#include "runners/command/command.hpp"

int main(int argc, char** argv) {
  return ricochet::run_command({argv + (argc > 0 ? 1 : 0), argv + argc}, std::cout, std::cerr);
}
