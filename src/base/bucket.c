#include "base/bucket.h"

#include <string.h>

void ax_bucket_sort(int items, int keys, const int* key, const int* order, int* start, int* sorted)
{
    memset(start, 0, (size_t)(keys + 1) * sizeof *start);
    for (int k = 0; k < items; ++k)
        ++start[key[k] + 1];
    for (int k = 0; k < keys; ++k)
        start[k + 1] += start[k];
    for (int k = 0; k < items; ++k) {
        int item = order ? order[k] : k;
        sorted[start[key[item]]++] = item;
    }
    for (int k = keys; k > 0; --k)
        start[k] = start[k - 1];
    start[0] = 0;
}
