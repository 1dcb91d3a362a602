/* The reader in one header and this interface in one program, and in one file: no name is in both. */
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include <stdio.h>
#include <stdlib.h>

#include <welkin/capi.h>

int main(void)
{
    WelkinError error;
    WelkinModel *model;
    if (welkin_check_abi(WELKIN_ABI, &error) != WELKIN_STATUS_OK) return EXIT_FAILURE;
    if (welkin_model_default(&model, &error) != WELKIN_STATUS_OK) return EXIT_FAILURE;

    static const unsigned char none[256];
    welkin_file file;
    if (welkin_open(&file, none, sizeof none) != WELKIN_ERROR_MAGIC) return EXIT_FAILURE;
    puts(welkin_error_name(WELKIN_ERROR_MAGIC));
    puts(welkin_status_name(WELKIN_STATUS_MAGIC));
    welkin_model_free(model);
    return EXIT_SUCCESS;
}
