//! The three calls into the kernel that the framebuffer needs, with the kernel's own structures (`linux/fb.h`).
#![expect(unsafe_code, reason = "an ioctl hands the kernel a structure to fill: its layout is checked below")]

use std::ffi::{c_char, c_ulong};
use std::fs::File;
use std::io;

use rustix::ioctl::{Getter, IntegerSetter, Opcode, ioctl};

use super::geometry::{BitField, Screen};

const FBIOGET_VSCREENINFO: Opcode = 0x4600;
const FBIOGET_FSCREENINFO: Opcode = 0x4602;
const FBIOBLANK: Opcode = 0x4611;
/// `FB_BLANK_UNBLANK`.
const UNBLANK: usize = 0;

/// `struct fb_bitfield`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct FbBitfield {
    offset: u32,
    length: u32,
    msb_right: u32,
}

/// `struct fb_var_screeninfo`; the timings are not looked at.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct FbVarScreeninfo {
    xres: u32,
    yres: u32,
    xres_virtual: u32,
    yres_virtual: u32,
    xoffset: u32,
    yoffset: u32,
    bits_per_pixel: u32,
    grayscale: u32,
    red: FbBitfield,
    green: FbBitfield,
    blue: FbBitfield,
    transp: FbBitfield,
    rest: [u32; 20],
}

/// `struct fb_fix_screeninfo`: 80 bytes where `unsigned long` has 64 bits, 68 where it has 32.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct FbFixScreeninfo {
    id: [c_char; 16],
    smem_start: c_ulong,
    smem_len: u32,
    kind: u32,
    type_aux: u32,
    visual: u32,
    xpanstep: u16,
    ypanstep: u16,
    ywrapstep: u16,
    line_length: u32,
    mmio_start: c_ulong,
    mmio_len: u32,
    accel: u32,
    capabilities: u16,
    reserved: [u16; 2],
}

// The sizes that a C compiler gives the structures of linux/fb.h on 64-bit Linux.
const _: () = assert!(size_of::<FbVarScreeninfo>() == 160);
#[cfg(target_pointer_width = "64")]
const _: () = assert!(size_of::<FbFixScreeninfo>() == 80 && std::mem::offset_of!(FbFixScreeninfo, line_length) == 48);

/// What the device says of itself.
pub(super) fn screen(device: &File) -> io::Result<Screen> {
    // SAFETY: these opcodes fill exactly these structures, whose layout is that of linux/fb.h; all bit patterns are valid.
    let (var, fix) = unsafe {
        (
            ioctl(device, Getter::<FBIOGET_VSCREENINFO, FbVarScreeninfo>::new())?,
            ioctl(device, Getter::<FBIOGET_FSCREENINFO, FbFixScreeninfo>::new())?,
        )
    };
    let field = |f: FbBitfield| BitField { offset: f.offset, length: f.length, msb_right: f.msb_right };
    Ok(Screen {
        xres: var.xres,
        yres: var.yres,
        yres_virtual: var.yres_virtual,
        xoffset: var.xoffset,
        yoffset: var.yoffset,
        bits_per_pixel: var.bits_per_pixel,
        grayscale: var.grayscale,
        red: field(var.red),
        green: field(var.green),
        blue: field(var.blue),
        kind: fix.kind,
        line_length: fix.line_length,
        smem_len: fix.smem_len,
    })
}

/// Wakes a screen that the console has put to sleep. Not every driver can; what is asleep then stays dark.
pub(super) fn unblank(device: &File) -> io::Result<()> {
    // SAFETY: this opcode takes a small integer by value.
    unsafe { Ok(ioctl(device, IntegerSetter::<FBIOBLANK>::new_usize(UNBLANK))?) }
}
