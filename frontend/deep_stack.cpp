// Makes a thread with a large stack.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/deep_stack.h"

#include <cstddef>
#include <exception>
#include <pthread.h>

#include "base/diagnostics.h"

namespace glint::frontend {
namespace {

constexpr size_t kDeepest = size_t{1} << 30, kShallowest = size_t{8} << 20;  // bytes

struct Task {
  const std::function<void()>& work;
  std::exception_ptr thrown = nullptr;
};

void* run_task(void* argument) {
  Task& task = *static_cast<Task*>(argument);
  try {
    task.work();
  } catch (...) {
    task.thrown = std::current_exception();
  }
  return nullptr;
}

bool start(pthread_t* thread, size_t stack_bytes, Task* task) {
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return false;
  const bool started = pthread_attr_setstacksize(&attributes, stack_bytes) == 0 &&
                       pthread_create(thread, &attributes, run_task, task) == 0;
  pthread_attr_destroy(&attributes);
  return started;
}

}  // namespace

void on_deep_stack(const std::function<void()>& work) {
  Task task{work};
  pthread_t thread;
  size_t bytes = kDeepest;
  while (!start(&thread, bytes, &task)) {
    bytes /= 2;
    if (bytes < kShallowest) throw Error(Exit::Failure, "error: the system gives no thread to compile on");
  }
  pthread_join(thread, nullptr);
  if (task.thrown) std::rethrow_exception(task.thrown);
}

}  // namespace glint::frontend
