// Keeps two processes from writing results into one folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace glint::report {

// This is the name of the file whose lock is the lock of its folder.
inline constexpr const char* kLockFile = "glint.lock";

// Holds the lock of a folder. The system releases it when the process ends, however it ends. The lock is a
// lock on kLockFile in the folder, which is removed with it; a killed process leaves the file,
// and the next one takes it over.
class FolderLock {
 public:
  FolderLock() = default;
  // Throws UserError when another process holds the lock, or the folder cannot be written. A file system
  // without locks has none of this.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;

 private:
  std::string path_;
  int file_ = -1;
};

// Returns whether a folder holds nothing, or only what a process leaves that was killed as it took the folder
// into use.
bool is_unused_folder(const std::string& folder);

}  // namespace glint::report
