#pragma once

#include <filesystem>
#include <string>

namespace twinmap::fmi {

/// Whether an FMU of some kind must have a function.
enum class Need { kNone, kOptional, kRequired };

/// The library of an FMU, loaded into this process. It stays loaded to the end of the process: what its
/// threads and exit handlers do after an unloading is undefined.
class SharedLibrary {
 public:
  /// `prefix`: names of functions may begin with it ("crane_", of libraries that hold several FMUs). Throws
  /// ExperimentError with the loader's words if the library or what it needs cannot be loaded.
  SharedLibrary(const std::filesystem::path& path, std::string prefix);

  /// Null if there is none or none is needed. Throws ExperimentError that names a required function if there
  /// is none.
  template <class Function>
  void load(Function*& function, const char* prefix, const char* name, Need need) const {
    function = reinterpret_cast<Function*>(find(std::string(prefix) + name, need));
  }

 private:
  void* find(const std::string& name, Need need) const;

  std::string file_name_, prefix_;
  void* handle_;
};

}  // namespace twinmap::fmi
