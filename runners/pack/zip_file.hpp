#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

struct archive;

namespace ricochet {

/// Writes a zip file in which the same parts make the same bytes: no times, no owners, one mode. Nothing is seen of it
/// before commit(). Throws StoreError.
class ZipWriter {
 public:
  explicit ZipWriter(const std::filesystem::path& file);
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  void add(const std::string& name, std::string_view content);
  void add_file(const std::string& name, const std::filesystem::path& file);
  void commit();

 private:
  struct Body;
  void begin(const std::string& name, long long size);
  void data(std::string_view bytes);
  Body* body_;
};

/// What is done with the parts of a zip file, in their order.
struct ZipVisitor {
  std::function<void(const std::string& name)> begin;
  std::function<void(std::string_view bytes)> data;  ///< of the part that began last
  std::function<void()> end;
};

/// Reads a zip file of files with plain relative names. Throws InputError with the cause where it is none or is cut;
/// where a name climbs out, is absolute, stands twice or is no plain text; for links, devices, folders and encrypted
/// parts; and where the parts are more than `most_expansion` times the file and `always_allowed` bytes.
void read_zip(const std::filesystem::path& file, const ZipVisitor& visitor);

inline constexpr double most_expansion = 200, always_allowed = 1e8;

}  // namespace ricochet
