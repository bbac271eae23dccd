#include "framework/models/fmu/instance/shared_library.hpp"

#include <dlfcn.h>

#include "framework/base/text/source_location.hpp"

namespace twinmap::fmi {

SharedLibrary::SharedLibrary(const std::filesystem::path& path, std::string prefix)
    : file_name_(path.filename().string()),
      prefix_(std::move(prefix)),
      handle_(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    const char* reason = dlerror();
    throw ExperimentError("the FMU's library cannot be loaded: " +
                          std::string(reason == nullptr ? file_name_ : reason));
  }
}

void* SharedLibrary::find(const std::string& name, Need need) const {
  if (need == Need::kNone) {
    return nullptr;
  }
  void* symbol = dlsym(handle_, name.c_str());
  symbol = symbol != nullptr ? symbol : dlsym(handle_, (prefix_ + name).c_str());
  if (symbol == nullptr && need == Need::kRequired) {
    throw ExperimentError("the FMU's library " + file_name_ + " has no function " + name);
  }
  return symbol;
}

}  // namespace twinmap::fmi
