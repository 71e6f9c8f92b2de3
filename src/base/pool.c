// Loops here last tens of microseconds, so waiting threads spin for about as long before they sleep: waking a sleeping thread
// costs more than the loop. Indices are claimed one by one, and a loop ends when all threads that entered it have left: one
// that the system has not scheduled in time enters no more and holds nobody up, so a busy machine costs its share and no more.
#include "base/pool.h"

#include "ax/base.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { SPINS = 20000, MOST_THREADS = 64 };

static const unsigned long long CLOSED = 1ull << 31, INSIDE = (1ull << 31) - 1;

struct ax_pool {
    int threads;
    pthread_t thread[MOST_THREADS];
    pthread_mutex_t lock;
    pthread_cond_t wake;
    atomic_ullong gate; // number of the loop << 32 | CLOSED once its indices are gone | threads inside
    atomic_int sleeping, next;
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

static unsigned long long loop_of(unsigned long long gate)
{
    return gate >> 32;
}

static void* run(void* argument)
{
    ax_pool* pool = argument;
    unsigned long long seen = 0, gate;
    while (true) {
        for (int spin = 0; loop_of(gate = atomic_load(&pool->gate)) == seen && spin < SPINS; ++spin)
            pause_briefly();
        if (loop_of(gate) == seen) {
            pthread_mutex_lock(&pool->lock);
            atomic_fetch_add(&pool->sleeping, 1);
            while (loop_of(gate = atomic_load(&pool->gate)) == seen)
                pthread_cond_wait(&pool->wake, &pool->lock);
            atomic_fetch_sub(&pool->sleeping, 1);
            pthread_mutex_unlock(&pool->lock);
        }
        if (atomic_load(&pool->stop))
            return NULL;
        // enter while the loop is open
        while (!(gate & CLOSED) && !atomic_compare_exchange_weak(&pool->gate, &gate, gate + 1))
            ;
        seen = loop_of(gate);
        if (gate & CLOSED)
            continue;
        work(pool);
        atomic_fetch_sub(&pool->gate, 1);
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

// Opens the next loop; nobody is inside the one before.
static void open_gate(ax_pool* pool)
{
    atomic_store(&pool->gate, (loop_of(atomic_load(&pool->gate)) + 1) << 32);
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
    open_gate(pool);
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
    atomic_store(&pool->next, 0);
    open_gate(pool);
    work(pool);
    atomic_fetch_or(&pool->gate, CLOSED);
    while (atomic_load(&pool->gate) & INSIDE) // others are at most one index behind
        pause_briefly();
}
