// SPDX-License-Identifier: Apache-2.0
#include "tests/wire/largest_allocation.hpp"

#include <cstdlib>
#include <new>

std::size_t adit::wire::largest_allocation = 0;

// A translation unit of its own: nothing of it is inlined where the compiler would pair it with the
// library's.
void* operator new(std::size_t size) {
  if (size > adit::wire::largest_allocation) adit::wire::largest_allocation = size;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
