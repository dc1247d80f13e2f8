#include "runners/command/subcommand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <sstream>

namespace ricochet {
namespace po = boost::program_options;
namespace {

template <class Value>
po::value_semantic* value_called(const std::string& name) {
  return po::value<Value>()->value_name(name);
}

po::options_description described(const Subcommand& command) {
  po::options_description all("Options");
  for (const Option& option : command.options) {
    const char *name = option.name.c_str(), *text = option.text.c_str();
    const auto add = [&](po::value_semantic* value) { all.add_options()(name, value, text); };
    if (option.value.empty())
      all.add_options()(name, text);
    else if (std::holds_alternative<Option::Count>(option.target))
      add(value_called<int>(option.value));
    else if (std::holds_alternative<std::optional<double> Arguments::*>(option.target))
      add(value_called<double>(option.value));
    else if (std::holds_alternative<std::vector<std::filesystem::path> Arguments::*>(option.target))
      add(value_called<std::vector<std::string>>(option.value));
    else
      add(value_called<std::string>(option.value));
  }
  all.add_options()("help", "this text");
  return all;
}

std::vector<std::string> option_names(const po::options_description& description) {
  std::vector<std::string> names;
  for (const auto& option : description.options()) names.push_back("--" + option->long_name());
  return names;
}

std::string see_help(const Subcommand& command) {
  return "\nUsage: ricochet " + command.name + " " + command.usage;
}

/// What was meant by an option that a command does not have: one of its own, else one of another command.
std::string instead_of(const std::string& name, const Subcommand& command, const po::options_description& own) {
  if (const std::string nearest = nearest_name(name, option_names(own)); !nearest.empty())
    return "; did you mean " + nearest + "?";
  std::string near;
  for (const Subcommand& other : subcommands()) {
    if (other.name == command.name) continue;
    const std::string nearest = nearest_name(name, option_names(described(other)));
    if (nearest.empty() || (!near.empty() && nearest != name)) continue;
    near = "; `ricochet " + other.name + "` has " + nearest;
    if (nearest == name) break;
  }
  return near;
}

po::variables_map parse(const Subcommand& command, const po::options_description& named,
                        const std::vector<std::string>& words) {
  po::options_description all = named;
  all.add_options()("operand", po::value<std::vector<std::string>>());
  po::positional_options_description positions;
  positions.add("operand", -1);
  // No guessing: half an option name is an error, not another option.
  namespace style = po::command_line_style;
  constexpr int strict = style::unix_style & ~style::allow_guessing;
  po::variables_map values;
  try {
    po::store(po::command_line_parser(words).options(all).positional(positions).style(strict).run(), values);
  } catch (const po::unknown_option& error) {
    std::string name = error.get_option_name();
    if (!name.starts_with("-")) name = "--" + name;
    name.resize(std::min(name.size(), name.find('=')));
    throw UsageError(command.name + " has no option " + name + instead_of(name, command, named) + see_help(command));
  } catch (const po::invalid_option_value& error) {
    const bool real = error.get_option_name() == "--parameter" || error.get_option_name() == "--arc";
    const char* wanted = real ? "; expected a number" : "; expected a whole number";
    throw UsageError(error.what() + std::string(wanted) + see_help(command));
  } catch (const po::error& error) {
    throw UsageError(error.what() + see_help(command));
  }
  return values;
}

/// Puts the value of one option where it belongs.
struct Placed {
  Arguments& into;
  const std::string& name;
  const po::variable_value& value;

  void operator()(std::monostate) const {}
  void operator()(bool Arguments::*member) const { into.*member = true; }
  void operator()(const Option::Count& count) const {
    const int given = value.as<int>();
    if (given < 1 || given > count.most)
      throw UsageError(fmt::format("--{} {} is outside [1, {}]", name, given, count.most));
    into.*count.value = given;
  }
  void operator()(std::optional<double> Arguments::*member) const { into.*member = value.as<double>(); }
  void operator()(std::string Arguments::*member) const { into.*member = value.as<std::string>(); }
  void operator()(std::optional<std::filesystem::path> Arguments::*member) const {
    if (value.as<std::string>().empty()) throw UsageError("--" + name + " was given an empty path");
    into.*member = value.as<std::string>();
  }
  void operator()(std::vector<std::filesystem::path> Arguments::*member) const {
    for (const std::string& file : value.as<std::vector<std::string>>()) {
      if (file.empty()) throw UsageError("--" + name + " was given an empty path");
      (into.*member).emplace_back(file);
    }
  }
  void operator()(StudyPart Arguments::*member) const {
    const auto& text = value.as<std::string>();
    const auto part = part_from(text);
    if (!part)
      throw UsageError(fmt::format("--part \"{}\": expected K/N, part K of N with 1 ≤ K ≤ N, such as 3/64", text));
    into.*member = *part;
  }
};

}  // namespace

Arguments parse_arguments(const Subcommand& command, const std::vector<std::string>& words) {
  const po::options_description named = described(command);
  const po::variables_map values = parse(command, named, words);
  Arguments arguments;
  arguments.help = values.count("help") > 0;
  if (arguments.help) return arguments;
  for (const Option& option : command.options)
    if (values.count(option.name)) std::visit(Placed{arguments, option.name, values[option.name]}, option.target);
  if (arguments.isolate && arguments.here) throw UsageError("--inline and --isolate exclude each other");
  if (values.count("operand")) arguments.operands = values["operand"].as<std::vector<std::string>>();
  if (std::any_of(arguments.operands.begin(), arguments.operands.end(), [](const auto& one) { return one.empty(); }))
    throw UsageError(command.name + " was given an empty argument" + see_help(command));
  if (arguments.operands.size() < command.fewest)
    throw UsageError("an argument of " + command.name + " is missing" + see_help(command));
  if (arguments.operands.size() > command.most)
    throw UsageError(command.name + " does not expect \"" + arguments.operands[command.most] + "\"" +
                     see_help(command));
  return arguments;
}

std::string help_text(const Subcommand& command) {
  std::ostringstream text;
  text << "Usage: ricochet " << command.name << (command.usage.empty() ? "" : " ") << command.usage << "\n\n"
       << command.summary << "\n\n"
       << described(command);
  return text.str();
}

}  // namespace ricochet
