#include "framework/models/mechanism/simbody_model.hpp"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>

#include "simbody_module.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

using MakeModel = SimbodyModel* (*)(const ModelSpec&);

/// The folder of the program or library that this code is in.
fs::path findOwnFolder() {
  static const char kHere = 0;
  Dl_info info{};
  link_map* map = nullptr;
  std::error_code failure;
  const bool found = dladdr1(&kHere, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0;
  const bool library = found && map->l_name != nullptr && map->l_name[0] != '\0';
  return (library ? fs::canonical(map->l_name, failure) : fs::read_symlink("/proc/self/exe", failure))
      .parent_path();
}

/// Beside the program or library, or in the folder for libraries below one of those above it, which holds for
/// an installation anywhere and for the folder of a build.
fs::path findModule() {
  std::error_code failure;
  const fs::path own = findOwnFolder();
  fs::path module = own / kSimbodyModule;
  for (fs::path above = own; !fs::is_regular_file(module, failure) && above.has_relative_path();
       above = above.parent_path()) {
    module = above / kSimbodyFolder / kSimbodyModule;
  }
  return fs::is_regular_file(module, failure) ? module : fs::path();
}

MakeModel loadModule() {
  const fs::path module = findModule();
  if (module.empty()) {
    throw std::runtime_error(std::string("Simbody is needed, which checks a model before a run: ") +
                             kSimbodyModule + " is neither beside twinmap nor in " + kSimbodyFolder +
                             " above it; install twinmap with it");
  }
  // never closed: objects of its classes may outlive any owner; local: its copies of our code stay its own
  void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* make = handle == nullptr ? nullptr : dlsym(handle, "twinmap_make_simbody_model");
  if (make == nullptr) {
    throw std::runtime_error(std::string("Simbody cannot be loaded, which checks a model before a run: ") +
                             dlerror() + "; install " + kSimbodyPackage);
  }
  return reinterpret_cast<MakeModel>(make);
}

}  // namespace

std::unique_ptr<SimbodyModel> makeSimbodyModel(const ModelSpec& model) {
  static const MakeModel make = loadModule();
  return std::unique_ptr<SimbodyModel>(make(model));
}

}  // namespace twinmap
