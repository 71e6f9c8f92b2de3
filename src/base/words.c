#include "ax/base.h"

#include <limits.h>
#include <math.h>
#include <string.h>
#include <time.h>

enum { LONGEST_WORD = 63 };

// Optimal string alignment: insertions, deletions, exchanged letters, and swapped neighbours count one each.
static int changed_letters(const char* a, const char* b)
{
    int rows[3][LONGEST_WORD + 2];
    int n = (int)strlen(a), m = (int)strlen(b);
    if (n > LONGEST_WORD || m > LONGEST_WORD)
        return INT_MAX;
    for (int j = 0; j <= m; ++j)
        rows[0][j] = j;
    for (int i = 1; i <= n; ++i) {
        int *row = rows[i % 3], *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
        row[0] = i;
        for (int j = 1; j <= m; ++j) {
            int best = above[j - 1] + (a[i - 1] != b[j - 1]);
            best = above[j] + 1 < best ? above[j] + 1 : best;
            best = row[j - 1] + 1 < best ? row[j - 1] + 1 : best;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && two_above[j - 2] + 1 < best)
                best = two_above[j - 2] + 1;
            row[j] = best;
        }
    }
    return rows[n % 3][m];
}

const char* ax_nearest_word(const char* word, int count, const char* const* candidates)
{
    const char* nearest = NULL;
    int fewest = (int)strlen(word) / 3 + 2;
    for (int k = 0; k < count; ++k) {
        int changed = changed_letters(word, candidates[k]);
        if (changed < fewest)
            fewest = changed, nearest = candidates[k];
    }
    return nearest;
}

void ax_day_words(double time, char words[16])
{
    time_t whole = (time_t)(fabs(time) < 1e12 ? time : 0);
    struct tm parts;
    bool known = fabs(time) < 1e12 && gmtime_r(&whole, &parts) && parts.tm_year > -1900 && parts.tm_year < 8100;
    if (!known || strftime(words, 16, "%Y-%m-%d", &parts) == 0)
        *words = '\0';
}
