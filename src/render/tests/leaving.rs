//! Devices that leave: what they had taken is made by others, the bytes are the same, and the report says who left.

use super::*;

/// With a fault in the devices that are started meanwhile.
fn with_fault<T>(fault: DeviceFault, work: impl FnOnce() -> T) -> T {
    DEVICE_FAULT.set(fault);
    let done = work();
    DEVICE_FAULT.set(DeviceFault::default());
    done
}

fn on(devices: &Devices, settings: &Settings) -> (Result<Report, Error>, Vec<u8>) {
    let mut rgb = Vec::new();
    let report = render_with(&scene(), settings, devices, &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    });
    (report, rgb)
}

/// So many devices on the same adapter; `software` is what they pretend to be.
fn devices(number: usize, software: bool) -> Devices {
    let open = |_| {
        let mut gpu = adapters::open(None).unwrap();
        gpu.software = software;
        gpu
    };
    Devices::of((0..number).map(open).collect())
}

fn right() -> Vec<u8> {
    rgb(&rendered(&settings(Backend::Cpu)).1)
}

#[test]
fn others_make_what_a_device_leaves() {
    let right = right();
    for ends in [Ends::Lost, Ends::Memory, Ends::Silent] {
        for (number, backend) in [(1, Backend::Gpu), (2, Backend::Gpu), (1, Backend::Auto)] {
            // There are six bands.
            for after in [0, 1, 2] {
                let devices = devices(number, false);
                let fault = DeviceFault {
                    after: Some((after, ends)),
                    patience: (ends == Ends::Silent).then_some(Duration::from_millis(300)),
                };
                let (report, bytes) = with_fault(fault, || on(&devices, &settings(backend)));
                let name = format!("{ends:?} after {after}, {number} devices, {backend:?}");
                let report = report.unwrap();
                assert!(bytes == right, "{name}");
                assert_eq!(report.revoked, None, "{name}");
                assert_eq!(report.pixels, u64::from(WIDTH * HEIGHT), "{name}");
                if backend == Backend::Gpu {
                    let left: Vec<_> = report
                        .workers
                        .iter()
                        .filter_map(|worker| worker.left.as_ref())
                        .collect();
                    assert_eq!(left.len(), number, "{name}: {left:?}");
                    let why = match ends {
                        Ends::Lost => "was lost while rendering (of a test)",
                        Ends::Memory => "is out of memory: of a test",
                        Ends::Silent => "has not answered",
                    };
                    assert!(left[0].contains(why), "{name}: {left:?}");
                    assert!(report.fallback.unwrap().contains(why), "{name}");
                    // A band may be made twice, and count for who left.
                    let cpu = &report.workers[0];
                    assert!(
                        cpu.name == "CPU" && cpu.bands >= 6 - number as u32 * after,
                        "{name}: {cpu:?}"
                    );
                }
            }
        }
    }
}

/// Nobody else may make the bytes of f32 as it comes.
#[test]
fn a_fast_picture_ends_with_its_device() {
    let fast = Settings {
        precision: Precision::Fast,
        ..settings(Backend::Gpu)
    };
    let fault = DeviceFault {
        after: Some((1, Ends::Lost)),
        patience: None,
    };
    let (report, bytes) = with_fault(fault, || on(&devices(2, false), &fast));
    assert!(
        matches!(report, Err(Error::Gpu(GpuError::Lost { .. }))),
        "{report:?}"
    );
    assert!(bytes.len() < right().len());
}

/// Several devices and the CPU, in any mix, make the same bytes.
#[test]
fn any_mix_of_workers_makes_the_same_bytes() {
    let (_, right) = antialiased(SOME, Backend::Cpu, 3, SamplePattern::Hash, 4);
    for (number, backend) in [(1, Backend::Auto), (2, Backend::Auto), (3, Backend::Gpu)] {
        let devices = devices(number, false);
        for threads in 1..4 {
            let wanted = Settings {
                samples: 3,
                threads: Some(threads),
                band_rows: Some(4),
                ..settings(backend)
            };
            let mut bytes = Vec::new();
            let report = render_with(&small(SOME), &wanted, &devices, &mut |band| {
                bytes.extend_from_slice(&band.rgb);
                Ok(())
            });
            let report = report.unwrap();
            assert!(
                bytes == right,
                "{number} devices, {threads} threads, {backend:?}"
            );
            assert_eq!((report.fallback, report.revoked), (None, None));
            let bands: u32 = report.workers.iter().map(|worker| worker.bands).sum();
            assert_eq!((bands, report.bands), (18, 18));
        }
    }
}

/// One thread is enough for a device and the CPU, whichever of them asks for the packed scene first.
#[test]
fn one_thread_is_enough() {
    let devices = devices(1, false);
    let wanted = Settings {
        threads: Some(1),
        ..settings(Backend::Auto)
    };
    let right = right();
    for _ in 0..100 {
        let (report, bytes) = on(&devices, &wanted);
        report.unwrap();
        assert!(bytes == right);
    }
}

/// Software is tried where the CPU makes one pixel after the other; whoever is quicker, the bytes are the same, and
/// it is said which one was left out.
#[test]
fn software_is_tried_or_left_out() {
    let devices = devices(1, true);
    let (report, bytes) = on(&devices, &settings(Backend::Auto));
    let report = report.unwrap();
    assert!(bytes == right());
    // The CPU has lanes for this scene.
    assert_eq!(report.backend, Backend::Cpu);
    assert!(report.workers.iter().all(|worker| !worker.is_device()));
    let mut large = small(SOME);
    large.camera.pixeldim = [400, 300];
    let wanted = Settings {
        samples: 4,
        ..Settings::default()
    };
    let mut hashes = Vec::new();
    for backend in [Backend::Auto, Backend::Cpu] {
        let mut rgb = Vec::new();
        let wanted = Settings {
            backend,
            ..wanted.clone()
        };
        let report = render_with(&large, &wanted, &devices, &mut |band| {
            rgb.extend_from_slice(&band.rgb);
            Ok(())
        });
        let report = report.unwrap();
        println!("{backend:?}: {:?}", report.workers);
        assert_eq!(report.revoked, None);
        hashes.push(rgb);
    }
    assert!(hashes[0] == hashes[1]);
}

/// Software that somebody else has opened is left out where the CPU makes many pixels at once, whatever was asked for;
/// not where it was asked for by name.
#[test]
fn open_software_is_left_out_where_the_cpu_is_quicker() {
    let mut gpu = adapters::open(None).unwrap();
    gpu.software = true;
    let made = |wanted: Settings| {
        let mut rgb = Vec::new();
        let report = render_live(&scene(), &wanted, &Live::on(&gpu), &mut |band| {
            rgb.extend_from_slice(&band.rgb);
            Ok(())
        });
        (report.unwrap(), rgb)
    };
    for precision in [Precision::Certified, Precision::Fast] {
        let (report, bytes) = made(Settings {
            precision,
            ..settings(Backend::Auto)
        });
        assert_eq!(report.backend, Backend::Cpu);
        assert_eq!(report.left_out.as_ref(), Some(&gpu.name));
        assert!(bytes == right(), "{precision:?}");
    }
    for wanted in [
        settings(Backend::Gpu),
        Settings {
            adapter: Some(gpu.name.clone()),
            ..settings(Backend::Auto)
        },
    ] {
        let (report, _) = made(wanted);
        assert_eq!(
            (report.backend, report.adapter.as_ref(), report.left_out),
            (Backend::Gpu, Some(&gpu.name), None)
        );
    }
}
