// Loops here last tens of microseconds, so waiting threads spin for about as long before they sleep: waking a sleeping thread
// costs more than the loop.
#include "base/pool.h"

#include "ax/base.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { SPINS = 20000, MOST_THREADS = 64 };

struct ax_pool {
    int threads;
    pthread_t thread[MOST_THREADS];
    pthread_mutex_t lock;
    pthread_cond_t wake;
    atomic_uint round; // even while idle; a new round starts a loop
    atomic_int sleeping, next, left;
    atomic_bool stop;
    void (*task)(void*, int);
    void* context;
    int count;
};

static inline void pause_briefly(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

static void work(ax_pool* pool)
{
    for (int index; (index = atomic_fetch_add(&pool->next, 1)) < pool->count;)
        pool->task(pool->context, index);
}

static void* run(void* argument)
{
    ax_pool* pool = argument;
    unsigned seen = 0;
    while (true) {
        for (int spin = 0; atomic_load(&pool->round) == seen && spin < SPINS; ++spin)
            pause_briefly();
        if (atomic_load(&pool->round) == seen) {
            pthread_mutex_lock(&pool->lock);
            atomic_fetch_add(&pool->sleeping, 1);
            while (atomic_load(&pool->round) == seen)
                pthread_cond_wait(&pool->wake, &pool->lock);
            atomic_fetch_sub(&pool->sleeping, 1);
            pthread_mutex_unlock(&pool->lock);
        }
        seen = atomic_load(&pool->round);
        if (atomic_load(&pool->stop))
            return NULL;
        work(pool);
        atomic_fetch_sub(&pool->left, 1);
    }
}

ax_pool* ax_pool_make(int threads)
{
    if (threads <= 0)
        threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (threads > MOST_THREADS)
        threads = MOST_THREADS;
    ax_pool* pool = AX_NEW0(ax_pool, 1);
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pool->threads = 1;
    while (pool->threads < threads && pthread_create(&pool->thread[pool->threads], NULL, run, pool) == 0)
        ++pool->threads; // a machine that grants fewer threads is only slower
    return pool;
}

static void start_round(ax_pool* pool)
{
    atomic_fetch_add(&pool->round, 1);
    if (atomic_load(&pool->sleeping)) {
        pthread_mutex_lock(&pool->lock);
        pthread_cond_broadcast(&pool->wake);
        pthread_mutex_unlock(&pool->lock);
    }
}

void ax_pool_free(ax_pool* pool)
{
    if (!pool)
        return;
    atomic_store(&pool->stop, true);
    pthread_mutex_lock(&pool->lock);
    atomic_fetch_add(&pool->round, 1);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (int k = 1; k < pool->threads; ++k)
        pthread_join(pool->thread[k], NULL);
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->wake);
    ax_free(pool);
}

int ax_pool_threads(const ax_pool* pool)
{
    return pool ? pool->threads : 1;
}

void ax_pool_run(ax_pool* pool, void (*task)(void* context, int index), void* context, int count)
{
    if (!pool || pool->threads == 1 || count == 1) {
        for (int k = 0; k < count; ++k)
            task(context, k);
        return;
    }
    pool->task = task;
    pool->context = context;
    pool->count = count;
    atomic_store(&pool->left, pool->threads - 1);
    atomic_store(&pool->next, 0);
    start_round(pool);
    work(pool);
    while (atomic_load(&pool->left)) // the others are at most one index behind
        pause_briefly();
}
