//! Programs in the languages that naga writes.

use std::collections::BTreeMap;

use naga::back::{glsl, hlsl, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::ModuleInfo;
use naga::{Module, ResourceBinding, ShaderStage};

use crate::program::{Program, module};

/// A program in other languages, with the entry point `main`.
///
/// ```
/// let sky = welkin_shaders::translations(&welkin_shaders::PROGRAMS[0])?;
/// assert!(sky.glsl.starts_with("#version 450"));
/// assert_eq!(sky.spirv[0], 0x0723_0203); // SPIR-V's magic number
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
pub struct Translation {
    /// GLSL 4.50: bindings of the groups one after the other, the table at 0, those of group 1 from 1 on.
    pub glsl: String,
    /// HLSL of shader model 5.1: groups are spaces.
    pub hlsl: String,
    /// SPIR-V 1.3 for Vulkan 1.1.
    pub spirv: Vec<u32>,
}

/// Translates a program.
///
/// # Errors
/// What naga says.
pub fn translations(program: &Program) -> Result<Translation, String> {
    let (module, info) = module(&program.source())?;
    Ok(Translation {
        glsl: to_glsl(&module, &info).map_err(|e| format!("{}: {e}", program.name))?,
        hlsl: to_hlsl(&module, &info).map_err(|e| format!("{}: {e}", program.name))?,
        spirv: to_spirv(&module, &info).map_err(|e| format!("{}: {e}", program.name))?,
    })
}

fn to_glsl(module: &Module, info: &ModuleInfo) -> Result<String, glsl::Error> {
    let bindings = (module.global_variables.iter()).filter_map(|(_, variable)| variable.binding);
    let flat = |b: ResourceBinding| (b.group + b.binding) as u8;
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        writer_flags: glsl::WriterFlags::empty(),
        binding_map: bindings.map(|b| (b, flat(b))).collect::<BTreeMap<_, _>>(),
        zero_initialize_workgroup_memory: false,
    };
    let entry = glsl::PipelineOptions {
        shader_stage: ShaderStage::Compute,
        entry_point: "main".into(),
        multiview: None,
    };
    let mut out = String::new();
    let policies = BoundsCheckPolicies::default();
    glsl::Writer::new(&mut out, module, info, &options, &entry, policies)?.write()?;
    Ok(out)
}

fn to_hlsl(module: &Module, info: &ModuleInfo) -> Result<String, hlsl::Error> {
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V5_1,
        zero_initialize_workgroup_memory: false,
        ..hlsl::Options::default()
    };
    let mut out = String::new();
    let entry = hlsl::PipelineOptions::default();
    hlsl::Writer::new(&mut out, &options, &entry).write(module, info, None)?;
    Ok(out)
}

fn to_spirv(module: &Module, info: &ModuleInfo) -> Result<Vec<u32>, spv::Error> {
    let options = spv::Options {
        lang_version: (1, 3),
        ..spv::Options::default()
    };
    spv::write_vec(module, info, &options, None)
}
