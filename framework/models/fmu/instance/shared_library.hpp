#pragma once

#include <filesystem>
#include <string>

namespace twinmap::fmi {

/// The library of an FMU, loaded into this process. It stays loaded to the end of the process: what its
/// threads and exit handlers do after an unloading is undefined.
class SharedLibrary {
 public:
  /// `prefix`: names of functions may begin with it ("crane_", of libraries that hold several FMUs). Throws
  /// ExperimentError with the loader's words if the library or what it needs cannot be loaded.
  SharedLibrary(const std::filesystem::path& path, std::string prefix);

  /// Null if there is none.
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(findSymbol(name));
  }

  /// Throws ExperimentError that names the function if there is none.
  template <class Function>
  Function* require(const char* name) const {
    return reinterpret_cast<Function*>(requireSymbol(name));
  }

 private:
  void* findSymbol(const char* name) const;
  void* requireSymbol(const char* name) const;

  std::string file_name_, prefix_;
  void* handle_;
};

}  // namespace twinmap::fmi
