//! System calls, by seccomp.
//!
//! The list names what no decoder, encoder or thread needs. It is a list of what is forbidden and not of what is allowed,
//! because the latter depends on the C library and would break with the next one.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use seccompiler::{
    BackendError, BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter,
    SeccompRule, TargetArch, apply_filter_all_threads,
};

use super::{Breach, NotConfined};

const ACTIONS: &str = "/proc/sys/kernel/seccomp/actions_avail";

/// Calls that are given up whatever their arguments are.
const GIVEN_UP: &[&[i64]] = &[
    // Connections.
    &[libc::SYS_socket, libc::SYS_socketpair],
    // Programs.
    &[libc::SYS_execve, libc::SYS_execveat],
    // Other processes: their memory, signals, descriptors.
    &[
        libc::SYS_ptrace,
        libc::SYS_process_vm_readv,
        libc::SYS_process_vm_writev,
        libc::SYS_process_madvise,
        libc::SYS_kcmp,
        libc::SYS_pidfd_open,
        libc::SYS_pidfd_getfd,
        libc::SYS_pidfd_send_signal,
        libc::SYS_kill,
        libc::SYS_tkill,
        libc::SYS_rt_sigqueueinfo,
        libc::SYS_rt_tgsigqueueinfo,
        libc::SYS_shmget,
        libc::SYS_semget,
        libc::SYS_msgget,
        libc::SYS_mq_open,
        libc::SYS_mq_unlink,
    ],
    // What stands beside a file's content, which Landlock leaves alone: rights, owners, times, attributes, length.
    &[
        libc::SYS_fchmod,
        libc::SYS_fchmodat,
        FCHMODAT2,
        libc::SYS_fchown,
        libc::SYS_fchownat,
        libc::SYS_utimensat,
        libc::SYS_setxattr,
        libc::SYS_lsetxattr,
        libc::SYS_fsetxattr,
        libc::SYS_removexattr,
        libc::SYS_lremovexattr,
        libc::SYS_fremovexattr,
        libc::SYS_truncate,
        libc::SYS_inotify_init1,
        libc::SYS_fanotify_init,
    ],
    // Ways round the other rules.
    &[
        libc::SYS_io_uring_setup,
        libc::SYS_io_uring_enter,
        libc::SYS_io_uring_register,
        // Its flags cannot be seen from here, and no C library uses it.
        libc::SYS_openat2,
        libc::SYS_mknodat,
        libc::SYS_open_by_handle_at,
        libc::SYS_name_to_handle_at,
        libc::SYS_unshare,
        libc::SYS_setns,
        libc::SYS_chroot,
        libc::SYS_pivot_root,
        libc::SYS_mount,
        libc::SYS_umount2,
        libc::SYS_move_mount,
        libc::SYS_open_tree,
        libc::SYS_fsopen,
        libc::SYS_fsconfig,
        libc::SYS_fsmount,
        libc::SYS_fspick,
        libc::SYS_mount_setattr,
    ],
    // The kernel's parts that attacks on it begin with, and the machine.
    &[
        libc::SYS_bpf,
        libc::SYS_perf_event_open,
        libc::SYS_userfaultfd,
        libc::SYS_add_key,
        libc::SYS_request_key,
        libc::SYS_keyctl,
        libc::SYS_personality,
        libc::SYS_init_module,
        libc::SYS_finit_module,
        libc::SYS_delete_module,
        libc::SYS_kexec_load,
        libc::SYS_reboot,
        libc::SYS_swapon,
        libc::SYS_swapoff,
        libc::SYS_acct,
        libc::SYS_quotactl,
        libc::SYS_syslog,
        libc::SYS_settimeofday,
        libc::SYS_clock_settime,
        libc::SYS_clock_adjtime,
        libc::SYS_adjtimex,
        libc::SYS_sethostname,
        libc::SYS_setdomainname,
        libc::SYS_setuid,
        libc::SYS_setgid,
        libc::SYS_setreuid,
        libc::SYS_setregid,
        libc::SYS_setresuid,
        libc::SYS_setresgid,
        libc::SYS_setgroups,
        libc::SYS_capset,
    ],
    OLD,
];

/// TIOCSTI and TIOCLINUX: what a terminal is told by them, its shell does.
const TYPE_INTO_TERMINAL: u64 = 0x5412;
const COMMAND_CONSOLE: u64 = 0x541c;

/// The same number everywhere (Linux 6.6).
const FCHMODAT2: i64 = 452;

/// Older names of the same, which only this architecture still has.
#[cfg(target_arch = "x86_64")]
const OLD: &[i64] = &[
    libc::SYS_fork,
    libc::SYS_vfork,
    libc::SYS_chmod,
    libc::SYS_chown,
    libc::SYS_lchown,
    libc::SYS_utime,
    libc::SYS_utimes,
    libc::SYS_futimesat,
    libc::SYS_mknod,
    libc::SYS_inotify_init,
    libc::SYS_iopl,
    libc::SYS_ioperm,
    libc::SYS_modify_ldt,
    libc::SYS_kexec_file_load,
];
#[cfg(not(target_arch = "x86_64"))]
const OLD: &[i64] = &[];

/// The bit of calls in the x32 form, a second door to the same kernel, and the numbers that only this form has.
#[cfg(target_arch = "x86_64")]
const SECOND_DOOR: Option<(i64, std::ops::Range<i64>)> = Some((0x4000_0000, 512..548));
#[cfg(not(target_arch = "x86_64"))]
const SECOND_DOOR: Option<(i64, std::ops::Range<i64>)> = None;

/// A rule about one argument: some of its bits, or its value.
fn when(argument: u8, operator: SeccompCmpOp, value: u64) -> Result<SeccompRule, BackendError> {
    SeccompRule::new(vec![SeccompCondition::new(argument, SeccompCmpArgLen::Dword, operator, value)?])
}

/// Making files by opening them: where files get names, Landlock allows empty ones.
fn making_files() -> Result<Vec<(i64, Vec<SeccompRule>)>, BackendError> {
    let made = libc::O_CREAT as u64;
    let by_flags = |argument| when(argument, SeccompCmpOp::MaskedEq(made), made);
    Ok(vec![
        (libc::SYS_openat, vec![by_flags(2)?]),
        #[cfg(target_arch = "x86_64")]
        (libc::SYS_open, vec![by_flags(1)?]),
        #[cfg(target_arch = "x86_64")]
        (libc::SYS_creat, Vec::new()),
    ])
}

/// Calls that are given up with some arguments.
fn with_arguments() -> Result<[(i64, Vec<SeccompRule>); 4], BackendError> {
    let thread = libc::CLONE_THREAD as u64;
    let own = std::process::id().into();
    Ok([
        // New processes; threads stay.
        (libc::SYS_clone, vec![when(0, SeccompCmpOp::MaskedEq(thread), 0)?]),
        // Signals to others; the own end by an abort stays.
        (libc::SYS_tgkill, vec![when(0, SeccompCmpOp::Ne, own)?]),
        (libc::SYS_prlimit64, vec![when(0, SeccompCmpOp::Ne, 0)?]),
        // Typing into the terminal what its shell then does.
        (
            libc::SYS_ioctl,
            vec![when(1, SeccompCmpOp::Eq, TYPE_INTO_TERMINAL)?, when(1, SeccompCmpOp::Eq, COMMAND_CONSOLE)?],
        ),
    ])
}

fn filter(rules: BTreeMap<i64, Vec<SeccompRule>>, then: SeccompAction) -> Result<BpfProgram, BackendError> {
    let architecture = TargetArch::try_from(std::env::consts::ARCH)?;
    SeccompFilter::new(rules, SeccompAction::Allow, then, architecture)?.try_into()
}

fn filters(breach: Breach, makes_files: bool) -> Result<[BpfProgram; 2], BackendError> {
    let mut rules: BTreeMap<_, _> = GIVEN_UP.concat().into_iter().map(|call| (call, Vec::new())).collect();
    rules.extend(with_arguments()?);
    if !makes_files {
        rules.extend(making_files()?);
    }
    if let Some((bit, only)) = SECOND_DOOR {
        let again: Vec<_> = rules.iter().map(|(call, rules)| (call | bit, rules.clone())).collect();
        rules.extend(again);
        rules.extend(only.map(|call| (call | bit, Vec::new())));
    }
    let then = match breach {
        Breach::Ends => SeccompAction::KillProcess,
        Breach::Fails => SeccompAction::Errno(libc::EPERM as u32),
    };
    // Its flags cannot be seen from here: threads are started by the older call where this one is unknown.
    let newer = BTreeMap::from([(libc::SYS_clone3, Vec::new())]);
    Ok([filter(newer, SeccompAction::Errno(libc::ENOSYS as u32))?, filter(rules, then)?])
}

/// Gives the calls up in all threads, where the system can. Files can still be made where that is needed.
pub(crate) fn give_up(breach: Breach, makes_files: bool) -> Result<bool, NotConfined> {
    if !offered() {
        return Ok(false);
    }
    for filter in filters(breach, makes_files).map_err(|e| NotConfined(e.into()))? {
        apply_filter_all_threads(&filter).map_err(|e| NotConfined(e.into()))?;
    }
    Ok(true)
}

/// Every kernel with seccomp's filters names the actions that it knows. It is asked once: later that may be out of reach.
pub(crate) fn offered() -> bool {
    static OFFERED: OnceLock<bool> = OnceLock::new();
    let ask = || std::fs::read_to_string(ACTIONS).is_ok_and(|text| text.contains("kill_process"));
    *OFFERED.get_or_init(ask)
}
