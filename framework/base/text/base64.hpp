#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// Bytes as letters (RFC 4648, with padding), as pages have them.
std::string encodeBase64(const std::vector<unsigned char>& bytes);

}  // namespace twinmap
