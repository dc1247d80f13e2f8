#include <cxxabi.h>
#include <dlfcn.h>

#include <atomic>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <ricochet/contract/float_control.hpp>
#include <ricochet/loader/child.hpp>
#include <ricochet/loader/library.hpp>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace ricochet {
namespace fs = std::filesystem;
namespace {

// "undefined symbol: _Z7nowherev" → "undefined symbol: nowhere()"
std::string demangled(const std::string& text) {
  std::string result;
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && in_name(text[end])) ++end;
    if (end == at) {
      result += text[at++];
      continue;
    }
    const std::string word = text.substr(at, end - at);
    const std::unique_ptr<char, decltype(&std::free)> plain(
        word.starts_with("_Z") ? abi::__cxa_demangle(word.c_str(), nullptr, nullptr, nullptr) : nullptr, std::free);
    result += plain ? plain.get() : word;
    at = end;
  }
  return result;
}

// The handle, which is never closed but by who means to.
void* open_library(const fs::path& file, Registry& registry) {
  const KeepFloatControl control;  // -ffast-math in a plugin would be everyone's
  const std::string place = file.string() + ": ", path = fs::absolute(file).string();
  void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* told = ::dlerror();
    std::string reason = told ? told : "for no reason that the loader tells";
    if (reason.starts_with(path + ": ")) reason.erase(0, path.size() + 2);
    throw PluginError(place + "cannot be loaded: " + demangled(reason));
  }
  auto* const enter = reinterpret_cast<void (*)(Registry&)>(::dlsym(library, "ricochet_register"));
  if (!enter) throw PluginError(place + "has no function ricochet_register; does it end with RICOCHET_PLUGIN?");
  try {
    enter(registry);
  } catch (const PluginError& error) {
    throw PluginError(place + one_line(error.what()));
  } catch (const std::exception& error) {
    throw PluginError(place + "failed while registering: " + one_line(error.what()));
  } catch (...) {
    throw PluginError(place + "failed while registering, with an exception that says nothing");
  }
  return library;
}

std::atomic<bool> foreign_ran{false};
std::mutex described_mutex;
std::set<fs::path> described;

// Opened where an object is first asked for.
const Registry& methods_of(const fs::path& file) {
  static std::mutex mutex;
  static auto* const opened = new std::map<fs::path, Registry>;  // holds code: nothing destroys it
  const std::lock_guard guard(mutex);
  if (const auto found = opened->find(file); found != opened->end()) return found->second;
  if (!ForeignCode::may_run())
    throw PluginError(file.string() + ": this process runs no code of it, only its children do");
  Registry methods;
  methods.set_current_file(file.string());
  foreign_ran = true;
  load_library(file, methods);
  return opened->emplace(file, std::move(methods)).first->second;
}

template <class Interface>
const Entry<Interface>* entry_of(const Registry& registry, const std::string& name) {
  if constexpr (std::is_same_v<Interface, MassStrategy>)
    return registry.mass(name);
  else if constexpr (std::is_same_v<Interface, ContactLaw>)
    return registry.contact(name);
  else if constexpr (std::is_same_v<Interface, FrictionLaw>)
    return registry.friction(name);
  else if constexpr (std::is_same_v<Interface, TimeScheme>)
    return registry.time(name);
  else
    return registry.reference(name);
}

template <class Interface>
Maker<Interface> loading(Role role, const std::string& name, const fs::path& file) {
  return [identity = PluginIdentity{role_name(role), name, file.string()}](const Parameters& parameters) {
    const Entry<Interface>* entry = nullptr;
    {
      const PluginCallScope scope(identity, "load");
      entry = entry_of<Interface>(methods_of(identity.file), identity.name);
    }
    if (!entry) throw PluginError(identity.file + ": registers other methods when it is loaded again");
    return entry->make(parameters);
  };
}

// Numbers and texts, one after the other.
class Writer {
 public:
  template <class Number>
  void number(Number value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(const std::string& value) {
    number(value.size());
    bytes_ += value;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  /// Below `end`.
  std::size_t count(std::size_t end) {
    const auto value = number<std::size_t>();
    if (value >= end) refuse();
    return value;
  }
  bool truth() { return count(2) == 1; }
  std::string text() {
    const std::size_t size = count(bytes_.size());
    return std::string(take(size), size);
  }
  std::string short_text() { return cut_short(text()); }
  bool at_end() const { return at_ == bytes_.size(); }
  [[noreturn]] static void refuse() { throw PluginError("what its process said of it is no manual"); }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size() - at_) refuse();
    at_ += size;
    return bytes_.data() + at_ - size;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

void write(const ParameterValue& value, Writer& out) {
  out.number(value.index());
  if (const auto* word = std::get_if<std::string>(&value)) return out.text(*word);
  if (const auto* table = std::get_if<ParameterTable>(&value)) {
    out.number(table->size());
    for (const auto& row : *table)
      for (const double number : row) out.number(number);
    return;
  }
  std::visit(
      [&](const auto& one) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(one)>>) out.number(one);
      },
      value);
}

constexpr std::size_t many = 100000;

ParameterValue read_value(Reader& in) {
  constexpr std::size_t reals = 0, integers = 1, booleans = 2, words = 3;
  switch (in.count(std::variant_size_v<ParameterValue>)) {
    case reals:
      return in.number<double>();
    case integers:
      return in.number<long long>();
    case booleans:
      return in.number<char>() != 0;
    case words:
      return in.text();
    default:
      break;
  }
  ParameterTable table(in.count(many));
  for (auto& row : table)
    for (double& number : row) number = in.number<double>();
  return table;
}

void write(const ParameterSpec& spec, Writer& out) {
  out.text(spec.key);
  out.number(static_cast<std::size_t>(spec.type));
  out.text(spec.unit);
  out.number(std::size_t{spec.fallback.has_value()});
  if (spec.fallback) write(*spec.fallback, out);
  out.number(spec.range.low);
  out.number(spec.range.high);
  for (const bool fact : {spec.range.low_open, spec.range.high_open, spec.per_lane}) out.number(std::size_t{fact});
  out.number(spec.words.size());
  for (const std::string& word : spec.words) out.text(word);
  out.text(spec.text);
  out.number(static_cast<std::size_t>(spec.role));
}

ParameterSpec read_spec(Reader& in) {
  constexpr std::size_t types = 5, roles = 4;
  ParameterSpec spec;
  spec.key = in.text();
  spec.type = static_cast<ParameterSpec::Type>(in.count(types));
  spec.unit = in.short_text();
  if (in.truth()) spec.fallback = read_value(in);
  spec.range.low = in.number<double>();
  spec.range.high = in.number<double>();
  for (bool* fact : {&spec.range.low_open, &spec.range.high_open, &spec.per_lane}) *fact = in.truth();
  for (std::size_t left = in.count(many); left > 0; --left) spec.words.push_back(in.text());
  spec.text = in.short_text();
  spec.role = static_cast<ParameterRole>(in.count(roles));
  return spec;
}

}  // namespace

void load_library(const fs::path& file, Registry& registry) {
  open_library(file, registry);
}

std::vector<fs::path> described_libraries() {
  const std::lock_guard guard(described_mutex);
  return {described.begin(), described.end()};
}

bool foreign_code_ran() {
  return foreign_ran;
}

std::string manuals_to_bytes(const Registry& registry) {
  Writer out;
  for (const Role role : all_roles) {
    const std::vector<std::string> names = registry.names(role);
    out.number(names.size());
    for (const std::string& name : names) {
      const PluginManual& manual = *registry.manual(role, name);
      for (const std::string* text : {&manual.name, &manual.summary, &manual.text, &manual.source, &manual.words})
        out.text(*text);
      out.number(manual.parameters.size());
      for (const ParameterSpec& spec : manual.parameters) write(spec, out);
    }
  }
  return out.take();
}

Registry methods_of_manuals(const std::string& bytes, const fs::path& file) {
  Reader in(bytes);
  Registry registry;
  registry.set_current_file(file.string());
  for (const Role role : all_roles)
    for (std::size_t left = in.count(many); left > 0; --left) {
      PluginManual manual;
      manual.name = in.text();
      for (std::string* text : {&manual.summary, &manual.text, &manual.source, &manual.words}) *text = in.short_text();
      for (std::size_t more = in.count(many); more > 0; --more) manual.parameters.push_back(read_spec(in));
      const std::string name = manual.name;
      switch (role) {
        case Role::mass:
          registry.add_mass(std::move(manual), loading<MassStrategy>(role, name, file));
          break;
        case Role::contact:
          registry.add_contact(std::move(manual), loading<ContactLaw>(role, name, file));
          break;
        case Role::friction:
          registry.add_friction(std::move(manual), loading<FrictionLaw>(role, name, file));
          break;
        case Role::time:
          registry.add_time(std::move(manual), loading<TimeScheme>(role, name, file));
          break;
        case Role::reference:
          registry.add_reference(std::move(manual), loading<ReferenceSolver>(role, name, file));
          break;
      }
    }
  if (!in.at_end()) Reader::refuse();
  return registry;
}

Registry describe_library(const fs::path& file, const std::function<void(const std::string&)>& remark) {
  constexpr double seconds = 10;
  {
    const std::lock_guard guard(described_mutex);
    described.insert(file);
  }
  void* library = nullptr;
  const ChildOutcome outcome = run_in_child({.work =
                                                 [&] {
                                                   Registry found;
                                                   library = open_library(file, found);
                                                   return manuals_to_bytes(found);
                                                 },
                                             .seconds = seconds,
                                             // In a process that ends, destructors of the library would run.
                                             .afterwards = [&] { ::dlclose(library); }});
  if (outcome.end == ChildOutcome::End::exception) throw PluginError(outcome.text);
  if (!outcome.ok()) throw PluginError(file.string() + ": " + outcome.cause() + " while it was loaded");
  if (!outcome.afterwards.empty() && remark)
    remark(file.string() + ": its static destructors: " + outcome.afterwards + "; Ricochet does not run them");
  try {
    return methods_of_manuals(outcome.text, file);
  } catch (const PluginError& error) {
    throw PluginError(file.string() + ": " + cut_short(error.what()));
  }
}

}  // namespace ricochet
