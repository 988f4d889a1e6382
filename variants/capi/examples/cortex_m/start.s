@ Start-up of a Cortex-M4F for both hosts, and their way to the debugger or emulator: semihosting.
  .syntax unified
  .section .vectors, "a"
  .word _stack_top
  .word reset
  .rept 14
  .word fault
  .endr

  .section .text.start, "ax"
  .thumb_func
  .globl reset
reset:
  ldr r0, =0xE000ED88 @ CPACR: the FPU on
  ldr r1, [r0]
  orr r1, r1, #0xf00000
  str r1, [r0]
  dsb
  isb
  ldr r0, =_sbss
  ldr r1, =_ebss
  movs r2, #0
1:
  cmp r0, r1
  itt lo
  strlo r2, [r0], #4
  blo 1b
  bl paint_stack
  bl host
  b quit

  .thumb_func
fault:
  movs r0, #102
  b quit

@ Fills the free part of the stack with a pattern.
  .thumb_func
  .globl paint_stack
paint_stack:
  ldr r0, =_ebss
  ldr r1, =0xa5a5a5a5
  mov r2, sp
1:
  cmp r0, r2
  itt lo
  strlo r1, [r0], #4
  blo 1b
  bx lr

@ Bytes of the stack that were in use since it was painted.
  .thumb_func
  .globl stack_used
stack_used:
  ldr r0, =_ebss
  ldr r1, =0xa5a5a5a5
1:
  ldr r2, [r0], #4
  cmp r2, r1
  beq 1b
  subs r0, #4
  ldr r1, =_stack_top
  subs r0, r1, r0
  bx lr

@ Prints a text that ends with a zero.
  .thumb_func
  .globl say
say:
  mov r1, r0
  movs r0, #4
  bkpt #0xab
  bx lr

@ Ends the program with a code.
  .thumb_func
  .globl quit
quit:
  push {r0, lr}
  ldr r1, =0x20026
  mov r2, r0
  push {r1, r2}
  mov r1, sp
  movs r0, #0x20
  bkpt #0xab
  b quit
  .section .note.GNU-stack, "", %progbits
