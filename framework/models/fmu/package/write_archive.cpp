#include "framework/models/fmu/package/write_archive.hpp"

#include <zip.h>

#include <memory>
#include <stdexcept>

namespace twinmap::fmi {
namespace {

constexpr zip_uint16_t kMidnight = 0, kFirstDay = (1 << 5) | 1;  // 1980-01-01: the archive tells no time

void add(zip_t* archive, const ArchiveFile& file) {
  zip_source_t* source = zip_source_buffer(archive, file.content.data(), file.content.size(), 0);
  const zip_int64_t index =
      source == nullptr ? -1 : zip_file_add(archive, file.name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    throw std::runtime_error(file.name + ": cannot be added: " + zip_strerror(archive));
  }
  zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), kMidnight, kFirstDay, 0);
}

}  // namespace

void writeArchive(const std::filesystem::path& path, const std::vector<ArchiveFile>& files) {
  int code = 0;
  std::unique_ptr<zip_t, decltype(&zip_discard)> archive(
      zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code), &zip_discard);
  if (archive == nullptr) {
    throw std::runtime_error(path.string() + ": cannot be written");
  }
  for (const ArchiveFile& file : files) {
    add(archive.get(), file);
  }
  if (zip_close(archive.get()) != 0) {
    throw std::runtime_error(path.string() + ": cannot be written: " + zip_strerror(archive.get()));
  }
  (void)archive.release();  // closing frees it
}

}  // namespace twinmap::fmi
