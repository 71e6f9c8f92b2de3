#include "ax/base.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void abort_on_exhaustion(size_t bytes)
{
    (void)bytes;
    abort();
}

static void (*exhausted)(size_t) = abort_on_exhaustion;
static atomic_size_t allocations;

void ax_set_out_of_memory(void (*handler)(size_t bytes))
{
    exhausted = handler ? handler : abort_on_exhaustion;
}

size_t ax_allocation_count(void)
{
    return allocations;
}

static size_t bytes_of(size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) {
        exhausted(SIZE_MAX);
        abort(); // a handler that returns breaks its contract
    }
    return bytes ? bytes : 1;
}

static void* checked(void* block, size_t bytes)
{
    if (!block) {
        exhausted(bytes);
        abort();
    }
    ++allocations;
    return block;
}

void* ax_alloc(size_t count, size_t size)
{
    size_t bytes = bytes_of(count, size);
    return checked(malloc(bytes), bytes);
}

void* ax_calloc(size_t count, size_t size)
{
    size_t bytes = bytes_of(count, size);
    return checked(calloc(bytes, 1), bytes);
}

void* ax_alloc_aligned(size_t count, size_t size)
{
    size_t bytes = (bytes_of(count, size) + 63) & ~(size_t)63;
    return checked(aligned_alloc(64, bytes), bytes);
}

void* ax_realloc(void* block, size_t count, size_t size)
{
    size_t bytes = bytes_of(count, size);
    return checked(realloc(block, bytes), bytes);
}

void* ax_copy(const void* block, size_t count, size_t size)
{
    if (!block)
        return NULL;
    void* copy = ax_alloc(count, size);
    memcpy(copy, block, count * size);
    return copy;
}

char* ax_copy_text(const char* text)
{
    return text ? ax_copy(text, strlen(text) + 1, 1) : NULL;
}

void ax_free(void* block)
{
    free(block);
}

void ax_trim_memory(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}
