// replaced by the first kernel
