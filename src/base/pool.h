// A few threads that stay awake between short parallel loops. What a loop computes must not depend on which thread runs
// which index: then results are the same bits for every number of threads.
#pragma once

typedef struct ax_pool ax_pool;

// `threads` includes the caller; 0 takes the number of cores. A pool of one thread starts none.
ax_pool* ax_pool_make(int threads);
void ax_pool_free(ax_pool* pool);
int ax_pool_threads(const ax_pool* pool);

// Runs task(context, 0) ... task(context, count - 1), in any order, and returns when all are done. NULL pool: in order, here.
void ax_pool_run(ax_pool* pool, void (*task)(void* context, int index), void* context, int count);
