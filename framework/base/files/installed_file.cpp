#include "framework/base/files/installed_file.hpp"

#include <dlfcn.h>
#include <link.h>
#include <sys/auxv.h>

#include <vector>

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// Where a package of Python may be that was installed below this folder.
std::vector<fs::path> listPackages(const fs::path& prefix) {
  std::vector<fs::path> packages{prefix / "twinmap"};
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(prefix / "lib", failure)) {
    if (entry.path().filename().string().rfind("python3", 0) == 0) {
      packages.push_back(entry.path() / "site-packages/twinmap");
      packages.push_back(entry.path() / "dist-packages/twinmap");
    }
  }
  return packages;
}

}  // namespace

fs::path findOwnFolder() {
  static const char kHere = 0;
  Dl_info info{};
  link_map* map = nullptr;
  std::error_code failure;
  const bool found = dladdr1(&kHere, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0;
  const bool library = found && map->l_name != nullptr && map->l_name[0] != '\0';
  if (library) {
    return fs::canonical(map->l_name, failure).parent_path();
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  // a root without /proc: by what it was started as
  const auto* started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return (failure && started != nullptr ? fs::canonical(started, failure) : program).parent_path();
}

fs::path findInstalled(const fs::path& path) {
  std::error_code failure;
  for (fs::path above = findOwnFolder(); above.has_relative_path(); above = above.parent_path()) {
    if (fs::exists(above / path, failure)) {
      return above / path;
    }
    for (const fs::path& package : listPackages(above)) {
      if (fs::exists(package / path, failure)) {
        return package / path;
      }
    }
  }
  return {};
}

}  // namespace twinmap
