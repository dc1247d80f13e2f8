#include <elf.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <ricochet/loader/catalogue.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

namespace fs = std::filesystem;

#if defined(__x86_64__)
constexpr Elf64_Half processor = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half processor = EM_AARCH64;
#else
constexpr Elf64_Half processor = EM_NONE;  // any: the loader will tell
#endif

[[noreturn]] void damaged(const std::string& what) {
  throw std::runtime_error("damaged: " + what);
}

// A file of which only what lies inside can be read.
class Bytes {
 public:
  explicit Bytes(const fs::path& file) {
    std::error_code error;
    // Before it is opened: opening a pipe waits for who writes to it.
    if (!fs::is_regular_file(file, error)) throw std::runtime_error("not a file");
    stream_.open(file, std::ios::binary);
    size_ = fs::file_size(file, error);
    if (!stream_ || error) throw std::runtime_error("cannot be read");
  }
  std::uint64_t size() const { return size_; }
  template <class Item>
  std::vector<Item> read(std::uint64_t offset, std::uint64_t count, const char* what) {
    if (offset > size_ || count > (size_ - offset) / sizeof(Item)) damaged(std::string(what) + " lies beyond its end");
    std::vector<Item> items(count);
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(reinterpret_cast<char*>(items.data()), static_cast<std::streamsize>(count * sizeof(Item)));
    if (!stream_) damaged(std::string(what) + " cannot be read");
    return items;
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

Elf64_Ehdr read_header(Bytes& bytes) {
  if (bytes.size() < SELFMAG) throw std::runtime_error("not a shared library");
  const auto magic = bytes.read<char>(0, SELFMAG, "its magic number");
  if (std::memcmp(magic.data(), ELFMAG, SELFMAG) != 0) throw std::runtime_error("not a shared library");
  const auto header = bytes.read<Elf64_Ehdr>(0, 1, "its header").front();
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || (processor != EM_NONE && header.e_machine != processor))
    throw std::runtime_error("built for another processor");
  if (header.e_type != ET_DYN) throw std::runtime_error("not a shared library, but another kind of binary");
  if (header.e_shnum > 0 && header.e_shentsize != sizeof(Elf64_Shdr)) damaged("its sections have an unknown size");
  return header;
}

}  // namespace

std::vector<ExportedSymbol> exported_symbols(const fs::path& file, std::string_view prefix) {
  Bytes bytes(file);
  const Elf64_Ehdr header = read_header(bytes);
  const auto sections = bytes.read<Elf64_Shdr>(header.e_shoff, header.e_shnum, "its section table");
  std::vector<ExportedSymbol> result;
  for (const Elf64_Shdr& table : sections) {
    if (table.sh_type != SHT_DYNSYM) continue;
    if (table.sh_link >= sections.size()) damaged("its symbols have no names");
    const Elf64_Shdr& names = sections[table.sh_link];
    const auto symbols = bytes.read<Elf64_Sym>(table.sh_offset, table.sh_size / sizeof(Elf64_Sym), "its symbol table");
    const auto text = bytes.read<char>(names.sh_offset, names.sh_size, "its table of names");
    for (const Elf64_Sym& symbol : symbols) {
      if (symbol.st_shndx == SHN_UNDEF || ELF64_ST_BIND(symbol.st_info) == STB_LOCAL) continue;
      if (symbol.st_name >= text.size()) damaged("a symbol has its name elsewhere");
      const auto first = text.begin() + static_cast<std::ptrdiff_t>(symbol.st_name);
      const std::string_view name(&*first, static_cast<std::size_t>(std::find(first, text.end(), '\0') - first));
      if (name.starts_with(prefix)) result.push_back({std::string(name), symbol.st_size});
    }
    break;  // there is one
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return result;
}

std::string build_id(const fs::path& file) {
  Bytes bytes(file);
  const Elf64_Ehdr header = read_header(bytes);
  for (const auto& section : bytes.read<Elf64_Shdr>(header.e_shoff, header.e_shnum, "its section table")) {
    if (section.sh_type != SHT_NOTE) continue;
    const auto note = bytes.read<char>(section.sh_offset, section.sh_size, "a note");
    constexpr std::string_view owner("GNU\0", 4);
    Elf64_Nhdr head;
    if (note.size() < sizeof(head) + owner.size()) continue;
    std::memcpy(&head, note.data(), sizeof(head));
    const std::string_view rest(note.data() + sizeof(head), note.size() - sizeof(head));
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == owner.size() && rest.starts_with(owner) &&
        head.n_descsz <= rest.size() - owner.size())
      return std::string(rest.substr(owner.size(), head.n_descsz));
  }
  return {};
}

}  // namespace ricochet
