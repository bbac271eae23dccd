#include "framework/models/mechanism/simbody_model.hpp"

#include <dlfcn.h>

#include <filesystem>

#include "framework/base/files/installed_file.hpp"
#include "simbody_module.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

using MakeModel = SimbodyModel* (*)(const ModelSpec&);

/// Beside the program or library, or where it is installed.
fs::path findModule() {
  std::error_code failure;
  const fs::path beside = findOwnFolder() / kSimbodyModule;
  return fs::is_regular_file(beside, failure) ? beside
                                              : findInstalled(fs::path(kSimbodyFolder) / kSimbodyModule);
}

MakeModel loadModule() {
  const fs::path module = findModule();
  if (module.empty()) {
    throw std::runtime_error(std::string("Simbody is needed, which checks a model before a run: ") +
                             kSimbodyModule + " is neither in " + findOwnFolder().string() + " nor in " +
                             kSimbodyFolder + " of a folder above it; install twinmap with it");
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
