#include <cstring>

#include "framework/base/text/source_location.hpp"
#include "framework/models/fmu/instance/common_instance.hpp"

namespace twinmap::fmi {
namespace {

/// Libraries built by an older draft have other signatures; the version is what tells.
void checkVersion(const char* found, char expected) {
  if (found == nullptr || found[0] != expected) {
    throw ExperimentError("the FMU's library is of FMI " + std::string(found == nullptr ? "?" : found) +
                          ", its model description of FMI " + expected);
  }
}

}  // namespace

class InstanceFactory::Impl {
 public:
  explicit Impl(const InstanceSource& source)
      : source_(source),
        library_(source.library, source.description.getCapabilities(source.kind).model_identifier + "_") {
    if (source.description.version == Version::k2) {
      checkVersion(functions_2_.emplace(library_, source.kind).GetVersion(), '2');
    } else {
      checkVersion(functions_3_.emplace(library_, source.kind).GetVersion(), '3');
    }
  }

  std::unique_ptr<Instance> make() {
    return functions_2_ ? makeInstance(*functions_2_, source_) : makeInstance(*functions_3_, source_);
  }

 private:
  InstanceSource source_;
  SharedLibrary library_;
  std::optional<Functions2> functions_2_;
  std::optional<Functions3> functions_3_;
};

InstanceFactory::InstanceFactory(const InstanceSource& source) : impl_(std::make_unique<Impl>(source)) {}
InstanceFactory::~InstanceFactory() = default;

std::unique_ptr<Instance> InstanceFactory::make() {
  return impl_->make();
}

}  // namespace twinmap::fmi
