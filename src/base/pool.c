// Loops here last tens of microseconds, so waiting threads spin for about as long before they sleep: waking a sleeping thread
// costs more than the loop. Every thread has a share of the indices, the same in each loop of that many, so that what it touched
// last time is still in its cache; then it takes what is left of the others'. Indices are claimed one by one, and a loop ends when
// all threads that entered it have left: one that the system has not scheduled in time enters no more and holds nobody up, so
// a busy machine costs its share and no more.
#include "base/pool.h"

#include "ax/base.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { SPINS = 20000, MOST_THREADS = 64 };

static const unsigned long long CLOSED = 1ull << 31, INSIDE = (1ull << 31) - 1;

// The indices next .. end - 1 of a thread, on a cache line of their own.
typedef struct share {
    _Alignas(64) atomic_int next;
    int end;
} share;

typedef struct member {
    struct ax_pool* pool;
    int number;
} member;

struct ax_pool {
    int threads;
    pthread_t thread[MOST_THREADS];
    pthread_mutex_t lock;
    pthread_cond_t wake;
    atomic_ullong gate; // number of the loop << 32 | CLOSED once its indices are gone | threads inside
    atomic_int sleeping;
    atomic_bool stop;
    void (*task)(void*, int);
    void* context;
    share* shares;                // per thread
    member members[MOST_THREADS]; // what threads are told; the caller is the first
};

static inline void pause_briefly(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

static void work(ax_pool* pool, int number)
{
    for (int k = 0; k < pool->threads; ++k) {
        share* from = pool->shares + (number + k) % pool->threads;
        for (int index; (index = atomic_fetch_add(&from->next, 1)) < from->end;)
            pool->task(pool->context, index);
    }
}

static unsigned long long loop_of(unsigned long long gate)
{
    return gate >> 32;
}

static void* run(void* argument)
{
    const member* self = argument;
    ax_pool* pool = self->pool;
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
        work(pool, self->number);
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
    pool->shares = ax_alloc_aligned((size_t)threads, sizeof *pool->shares);
    pool->threads = 1;
    while (pool->threads < threads) {
        member* next = pool->members + pool->threads;
        *next = (member){pool, pool->threads};
        if (pthread_create(&pool->thread[pool->threads], NULL, run, next))
            break; // a machine that grants fewer threads is only slower
        ++pool->threads;
    }
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
    ax_free(pool->shares);
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
    for (int k = 0; k < pool->threads; ++k) {
        atomic_store(&pool->shares[k].next, (int)((long long)count * k / pool->threads));
        pool->shares[k].end = (int)((long long)count * (k + 1) / pool->threads);
    }
    open_gate(pool);
    work(pool, 0);
    atomic_fetch_or(&pool->gate, CLOSED);
    while (atomic_load(&pool->gate) & INSIDE) // others are at most one index behind
        pause_briefly();
}
