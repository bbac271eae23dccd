#pragma once

namespace twinmap {

/// The standard normal number below which a share of `uniform`, in (0, 1), lies.
double toStandardNormal(double uniform);

}  // namespace twinmap
