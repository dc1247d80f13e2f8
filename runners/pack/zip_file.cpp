#include "runners/pack/zip_file.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <locale.h>

#include <fstream>
#include <memory>
#include <ricochet/contract/errors.hpp>
#include <set>
#include <vector>

#include "runners/store/atomic_file.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace fs = std::filesystem;

namespace {

/// While it lives, names are UTF-8 for this thread, whatever the locale: so they are marked, and so they are read.
class NamesInUtf8 {
 public:
  NamesInUtf8() : utf8_(newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)), before_(utf8_ ? uselocale(utf8_) : nullptr) {}
  NamesInUtf8(const NamesInUtf8&) = delete;
  NamesInUtf8& operator=(const NamesInUtf8&) = delete;
  ~NamesInUtf8() {
    if (!utf8_) return;
    uselocale(before_);
    freelocale(utf8_);
  }

 private:
  locale_t utf8_, before_;
};

}  // namespace

struct ZipWriter::Body {
  explicit Body(const fs::path& to) : name(to), file(to) {}
  fs::path name;
  FileWriter file;
  std::unique_ptr<archive, decltype(&archive_write_free)> zip{archive_write_new(), archive_write_free};
  std::string failure;  ///< of writing the file itself

  void check(la_ssize_t code) const {
    if (code >= ARCHIVE_OK) return;
    const char* cause = archive_error_string(zip.get());
    throw StoreError(failure.empty() ? fmt::format("{}: {}", name.string(), cause ? cause : "cannot be written")
                                     : failure);
  }
};

ZipWriter::ZipWriter(const fs::path& file) : body_(new Body(file)) {
  archive* zip = body_->zip.get();
  body_->check(archive_write_set_format_zip(zip));
  body_->check(archive_write_set_options(zip, "zip:compression=deflate"));
  body_->check(archive_write_set_bytes_in_last_block(zip, 1));
  body_->check(archive_write_open(
      zip, body_, nullptr,
      [](archive* at, void* data, const void* bytes, std::size_t size) -> la_ssize_t {
        auto& body = *static_cast<Body*>(data);
        try {
          body.file.write({static_cast<const char*>(bytes), size});
          return static_cast<la_ssize_t>(size);
        } catch (const StoreError& error) {
          body.failure = error.what();
          archive_set_error(at, ARCHIVE_FATAL, "cannot be written");
          return -1;
        }
      },
      nullptr));
}

ZipWriter::~ZipWriter() {
  if (body_->zip) archive_write_fail(body_->zip.get());
  delete body_;
}

void ZipWriter::begin(const std::string& name, long long size) {
  const NamesInUtf8 utf8;
  const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry(archive_entry_new(), archive_entry_free);
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), size);
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  body_->check(archive_write_header(body_->zip.get(), entry.get()));
}

void ZipWriter::data(std::string_view bytes) {
  if (!bytes.empty()) body_->check(archive_write_data(body_->zip.get(), bytes.data(), bytes.size()));
}

void ZipWriter::add(const std::string& name, std::string_view content) {
  begin(name, static_cast<long long>(content.size()));
  data(content);
}

void ZipWriter::add_file(const std::string& name, const fs::path& file) {
  const auto size = static_cast<long long>(fs::file_size(file));
  begin(name, size);
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> piece(1 << 20);
  long long read = 0;
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    read += stream.gcount();
    data({piece.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (read != size)
    throw StoreError(fmt::format("{}: has changed while it was packed, or cannot be read", file.string()));
}

void ZipWriter::commit() {
  body_->check(archive_write_close(body_->zip.get()));
  body_->zip.reset();
  body_->file.commit();
}

namespace {

/// As it stands in a sentence of one line.
std::string shown_name(const std::string& name) {
  std::string shown;
  for (const char c : plain_text(name)) shown += c == '\n' ? "<U+000A>" : c == '\t' ? "<U+0009>" : std::string(1, c);
  return cut_short(shown);
}

/// Why a part may not have this name; "" where it may.
std::string fault_of_name(const std::string& name) {
  // Of a file anywhere, and of a way to it that leaves room for where it is unpacked.
  constexpr std::size_t longest_name = 255, longest_way = 2000;
  if (name.empty()) return "a part has no name";
  const std::string shown = shown_name(name);
  if (name.size() > longest_way) return fmt::format("\"{}\" is longer than {} bytes", shown, longest_way);
  if (!is_plain(name) || name.find_first_of("\\\n\t") != std::string::npos)
    return fmt::format("\"{}\" is no plain name", shown);
  if (name.front() == '/') return fmt::format("\"{}\" is an absolute path", shown);
  for (std::size_t at = 0; at != std::string::npos;) {
    const std::size_t slash = name.find('/', at);
    const std::string step = name.substr(at, slash == std::string::npos ? slash : slash - at);
    if (step == "..") return fmt::format("\"{}\" climbs out of its folder", shown);
    if (step.size() > longest_name) return fmt::format("\"{}\" is longer than {} bytes", shown, longest_name);
    if (step.empty() || step == ".") return fmt::format("\"{}\" is no name of a file", shown);
    at = slash == std::string::npos ? slash : slash + 1;
  }
  return "";
}

class ZipReader {
 public:
  ZipReader(const fs::path& file, const ZipVisitor& visitor)
      : file_(file), visitor_(visitor), zip_(archive_read_new(), archive_read_free) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) refuse(fs::exists(file, error) ? "is no file" : "there is no such file");
    most_ = always_allowed + most_expansion * static_cast<double>(fs::file_size(file));
    // What stands in the directory at the end counts: a file that was cut has none.
    archive_read_support_format_zip_seekable(zip_.get());
    constexpr std::size_t block = 1 << 16;
    check(archive_read_open_filename(zip_.get(), file.c_str(), block));
  }

  void read() {
    const NamesInUtf8 utf8;
    archive_entry* entry = nullptr;
    for (;;) {
      const int code = archive_read_next_header(zip_.get(), &entry);
      if (code == ARCHIVE_EOF) return;
      check(code);
      const char* raw = archive_entry_pathname(entry);
      const std::string name = raw ? raw : "";
      if (const std::string fault = fault_of_name(name); !fault.empty()) refuse(fault);
      const std::string quoted = "\"" + name + "\"";
      if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_symlink(entry) || archive_entry_hardlink(entry))
        refuse(quoted + " is a link, a folder or a device; expected files alone");
      if (archive_entry_is_encrypted(entry)) refuse(quoted + " is encrypted");
      if (!names_.insert(name).second) refuse(quoted + " stands twice");
      if (is_folder_too(name)) refuse(quoted + " is a file, and the folder of another or in one");
      visitor_.begin(name);
      for (;;) {
        const la_ssize_t size = archive_read_data(zip_.get(), piece_.data(), piece_.size());
        if (size == 0) break;
        check(size);
        total_ += static_cast<double>(size);
        if (total_ > most_)
          refuse(fmt::format("its parts are more than {} times as large as it: no results are", most_expansion));
        visitor_.data({piece_.data(), static_cast<std::size_t>(size)});
      }
      visitor_.end();
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& cause) const {
    throw InputError("", fmt::format("{}: {}", file_.string(), cause));
  }
  /// Whether a name that stands already lies in this one as in a folder, or this one in it.
  bool is_folder_too(const std::string& name) const {
    const auto inside = names_.lower_bound(name + "/");
    if (inside != names_.end() && inside->starts_with(name + "/")) return true;
    for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
      if (names_.contains(name.substr(0, slash))) return true;
    return false;
  }
  void check(la_ssize_t code) const {
    if (code >= ARCHIVE_OK) return;
    const char* cause = archive_error_string(zip_.get());
    refuse(fmt::format("no whole zip file: {}", cause ? cause : "it cannot be read"));
  }

  const fs::path file_;
  const ZipVisitor& visitor_;
  const std::unique_ptr<archive, decltype(&archive_read_free)> zip_;
  std::vector<char> piece_ = std::vector<char>(1 << 20);
  std::set<std::string> names_;
  double total_ = 0, most_ = 0;
};

}  // namespace

void read_zip(const fs::path& file, const ZipVisitor& visitor) {
  ZipReader(file, visitor).read();
}

}  // namespace ricochet
