// Stable counting sort.
#pragma once

// Sorts the numbers of `items` items by key[item] in 0 .. keys - 1: those of key k lie in sorted[start[k]] .. sorted[start[k + 1] - 1]
// (start: keys + 1 entries). Equal keys keep the sequence of `order`, or of their numbers if it is NULL.
void ax_bucket_sort(int items, int keys, const int* key, const int* order, int* start, int* sorted);
