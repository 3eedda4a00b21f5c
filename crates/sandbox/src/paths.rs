//! Paths, by Landlock.

use std::path::PathBuf;

use landlock::{
    ABI, Access as _, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, Ruleset, RulesetAttr,
    RulesetCreated, RulesetCreatedAttr, RulesetError, Scope, path_beneath_rules,
};

use super::{Access, NotConfined};

/// The first version in which files can be moved from folder to folder at all.
const LEAST: ABI = ABI::V2;
/// The last version whose rights are given up, where the kernel has them: devices' own commands.
const MOST: ABI = ABI::V5;
/// Connections, and signals and sockets of other processes, are closed from these on.
const NETWORK: ABI = ABI::V4;
const OTHERS: ABI = ABI::V6;

/// A set of rules that allows nothing yet.
fn nothing() -> Result<RulesetCreated, RulesetError> {
    Ruleset::default()
        .set_compatibility(CompatLevel::HardRequirement)
        .handle_access(AccessFs::from_all(LEAST))?
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(AccessFs::from_all(MOST))?
        .handle_access(AccessNet::from_all(NETWORK))?
        .scope(Scope::from_all(OTHERS))?
        .create()
}

fn rights(access: Access) -> BitFlags<AccessFs> {
    let read = AccessFs::ReadFile | AccessFs::ReadDir;
    // To list a folder is to open it, which is needed to flush its entries to the disk.
    let name = AccessFs::MakeReg | AccessFs::Refer | AccessFs::ReadDir;
    let replace = name | AccessFs::RemoveFile;
    match access {
        Access::Read => read,
        Access::Name => name,
        Access::Replace => replace,
        Access::Write => {
            replace
                | read
                | AccessFs::WriteFile
                | AccessFs::Truncate
                | AccessFs::MakeDir
                | AccessFs::RemoveDir
        }
    }
}

/// Closes every path but these, where the system can.
pub(crate) fn close(reach: &[(PathBuf, Access)]) -> Result<bool, NotConfined> {
    let Ok(mut rules) = nothing() else { return Ok(false) };
    let wrong = |error: RulesetError| NotConfined(error.into());
    for (path, access) in reach {
        // Paths that are not there are left out.
        rules = rules.add_rules(path_beneath_rules([path], rights(*access))).map_err(wrong)?;
    }
    rules.restrict_self().map_err(wrong)?;
    Ok(true)
}

pub(crate) fn offered() -> bool {
    nothing().is_ok()
}
