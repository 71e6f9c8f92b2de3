#include "base/own.h"

#include "ax/base.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

bool ax_own_path(const char* beside, const char* built, const char* installed, char out[AX_OWN_PATH])
{
    const char* const others[] = {built, installed};
    ssize_t length = readlink("/proc/self/exe", out, AX_OWN_PATH - 1);
    while (length > 0 && out[length - 1] != '/')
        --length;
    if (length > 0 && (size_t)length + strlen(beside) < AX_OWN_PATH) {
        strcpy(out + length, beside);
        if (access(out, F_OK) == 0)
            return true;
    }
    for (int k = 0; k < 2; ++k) {
        int size = snprintf(out, AX_OWN_PATH, "%s", others[k]);
        if (size < AX_OWN_PATH && access(out, F_OK) == 0)
            return true;
    }
    *out = 0;
    return false;
}

static char examples[AX_OWN_PATH];

static void find_examples(void)
{
    ax_own_path("../share/auxshell/examples", AX_EXAMPLES_BUILT, AX_EXAMPLES_INSTALLED, examples);
}

const char* ax_examples_folder(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, find_examples);
    return examples;
}
